"""Errors of sides that waves enter through: by dashpots that are too soft or too stiff, and on rock by their place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.boundaries.edge import OPPOSITE
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene
from dembound.disks.sides import ground_at
from dembound.formulas.cause import MOTIONS, USUAL, Cause
from dembound.formulas.disks.entry import side_ends
from dembound.formulas.disks.held_sides import HeldSides
from dembound.formulas.disks.reflections import Reflected, Reflections
from dembound.formulas.disks.waves import crossing_time
from dembound.formulas.history import History, Motions

REPEATED = 1e-3
"""Share of an error that comes back from the rock once more, below which it no longer counts."""


@dataclass(frozen=True)
class DrivenSides:
    """The driven sides of one scene, which runs at a time step (s), and its sides on rock; held : its held sides.

    reflections : of its sides.
    """

    scene: DiskScene
    time_step: float
    held: HeldSides
    reflections: Reflections

    def causes(self, motions: Motions) -> Iterator[Cause]:
        """Errors of sides on rock, then of driven sides with dashpots; motions : by monitor."""
        yield from self._rock(motions)
        for side, waves in self.scene.case.driving.items():
            table = self.scene.case.side(side)
            if table.is_interface:
                continue
            if table.is_artificial and not table.absorbs:
                reason = f'"{table.type}" has no dashpots, by which its reflection would be known'
                yield Cause.unknown(f"{side} side", reason)
            if table.factors and table.dashpots_alone() != table:
                reason = "its springs send back waves, which check computes and an estimate does not"
                yield Cause.unknown(f"{side} side", reason)
            if table.factors:
                shares = self.reflections.of(self.scene, side, self.time_step)
                parts = {name: self._returned(own, side, waves, shares) for name, own in motions.items()}
                words = "by the reflection of dashpots at normal incidence"
                yield Cause(f"{side} side", words, parts, factor=USUAL)

    def _rock(self, motions: Motions) -> Iterator[Cause]:
        """Sides on rock, beyond the reflection of the rock."""
        for side, table in self.scene.case.boundary.items():
            if not table.is_interface:
                continue
            if self.scene.case.hole or self.scene.case.load or table.dashpots_alone() != table:
                reason = "dashpots stand for rock at normal incidence alone; at other angles it is not predicted"
                yield Cause.unknown(f"{side} side", reason)
            back = {motion: self.held.reflects(OPPOSITE[side], motion) for motion in table.factors}
            parts = {name: errors_on_rock(self.scene, side, own, back) for name, own in motions.items()}
            words = "by the place where its disks begin, beside the reflection of its rock at normal incidence"
            yield Cause(f"{side} side", words, parts, of_disks=True, factor=USUAL)

    def _returned(
        self, own: History, side: str, waves: Mapping[Motion, str], shares: Mapping[Motion, Reflected]
    ) -> dict[str, np.ndarray | float]:
        """Error of a driven side that withholds part of its wave, and reflects waves that return to it.

        A side that reflects R lets 1 − R of its wave in. Its reflection is the recorded motion again, delayed by the
        way to the far side, with the sign of that side's reflection, if that side is a free surface or otherwise
        reflects everything; else nothing that counts comes back. The out-of-phase part of what is withheld is a shift
        of the entry time, which is no error (entry.py).
        """
        axis = normal_axis(side)
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for motion in waves:
            column = axis_of_motion(side, motion)
            trip = 2.0 * crossing_time(self.scene, axis, motion)
            if motion not in shares or not math.isfinite(trip):
                continue
            later = own.time - trip
            share, sign = shares[motion], self.held.reflects(OPPOSITE[side], motion)
            sent = reflected_motion(own, column, share)
            kept = reflected_motion(own, column, Reflected(abs(share.dashpots), share.dashpots))
            for quantity, values in sent.items():
                back = sign * np.interp(later, own.time, values, left=0.0)
                errors[quantity][:, column] = back - kept[quantity]
        return dict(errors)


def reflected_motion(own: History, column: int, share: Reflected) -> dict[str, np.ndarray]:
    """Velocity and displacement (k,) that a side reflects of a recorded motion along x or y (column 0 or 1).

    In phase R/(1 − R) of the motion, as 1 − R of it has come in; the out-of-phase part has the shape of a mass's force,
    the acceleration, and no lasting displacement.
    """
    velocity, displacement = (own.values[quantity][:, column] for quantity in MOTIONS)
    acceleration = np.gradient(velocity, own.time)
    size = float(np.linalg.norm(acceleration))
    lag = -share.out_of_phase * float(np.linalg.norm(velocity)) / size if size > 0.0 else 0.0
    in_phase = (
        share.dashpots / (1.0 - share.dashpots) if share.dashpots < 1.0 else 0.0
    )  # without dashpots none comes in
    return {
        "velocity": in_phase * velocity + lag * acceleration,
        "displacement": in_phase * displacement + lag * velocity,
    }


def errors_on_rock(
    scene: DiskScene, side: str, own: History, back: Mapping[Motion, float]
) -> dict[str, np.ndarray | float]:
    """Errors (k, 2) of a recorded motion by a side on rock, by quantity.

    back : by kind of wave, the reflection of the opposite side, from which the motion comes back to the rock; 0 where
    nothing does, but for waves that only leave: there the recorded motion itself arrives.
    """
    axis, errors = normal_axis(side), {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
    driven, ground = scene.case.side(side).waves, ground_at(scene, side)
    for motion, (mass, stiffness) in side_ends(scene, side).items():
        speed, column = ground.wave_speeds(axis)[0 if motion == "p" else 1], axis_of_motion(side, motion)
        alpha = factors_in(scene, side)[motion] / homogenised_beta(scene, side, motion)
        if not math.isfinite(speed):
            continue
        trip = 2.0 * crossing_time(scene, axis, motion) if driven else 0.0
        returned = back[motion] if driven else 1.0
        lag = -2.0 * (stiffness * alpha**2 - mass) / (speed * (1.0 + alpha) ** 2)
        velocity = own.values["velocity"][:, column]
        rates = {"velocity": np.gradient(velocity, own.time), "displacement": velocity}
        for quantity, rate in rates.items():
            error = returned * lag * np.interp(own.time - trip, own.time, rate, left=0.0)
            again, late = (1.0 - alpha) / (1.0 + alpha) * returned, trip
            while driven and abs(again) > REPEATED and late < own.time[-1] - own.time[0]:
                errors[quantity][:, column] += again * np.interp(own.time - late, own.time, error, left=0.0)
                again, late = again * (1.0 - alpha) / (1.0 + alpha) * returned, late + trip
            errors[quantity][:, column] += error
    return dict(errors)

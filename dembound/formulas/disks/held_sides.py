"""Errors of sides of the problem itself, which hold disks at their centres, and of sides that waves enter through.

Dashpots of driven sides are too soft or too stiff, and on rock they are at another place. At the others waves return
early.

The rock is held at the plane of a side, but long waves on disks are reflected at a depth s inside (entry.py; D/2 for P
waves on a square lattice), so that the path of waves at normal incidence is 2s shorter. Where a side leaves motion
free, as a roller does along itself, mass begins at the plane and nothing is early.

Plane waves between a driven side at x = 0 and the far one at H, which reflect r₀ and r₁ of the velocity, −1 where they
hold it and 1 where they leave it free: with T = 2H/c and the wave a(t) as it comes to a monitor at x for the first
time,

    v(t) = Σ_k (r₀r₁)^k [a(t − kT) + r₁ a(t' − kT)],   t' = t − 2(H − x)/c.

On disks the way to the far side and back is shorter by 2s₁, a round trip by 2(s₀ + s₁). The error of one side is the
change by its s alone; to the first order both add. That a is early by s₀/c is no error (entry.py). Dashpots and a
continuum at x = 0 have r₀ = 0: their reflection is another cause.

Other waves, of loads, scattered by holes or along a side, come back from all directions: their error is found with
companions that have one more row of larger disks, or a mirror plane, there (`errors_of_held_side`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries import SIDES, Motion, axis_of_motion, normal_axis
from dembound.boundaries.edge import OPPOSITE, plane_of
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene
from dembound.disks.sides import ground_at
from dembound.formulas.cause import MOTIONS, USUAL, Cause
from dembound.formulas.disks.entry import Entry, depths_held, entries_of, side_ends
from dembound.formulas.disks.reflections import Reflected, Reflections
from dembound.formulas.disks.waves import crossing_time
from dembound.formulas.history import History, Motions


@dataclass(frozen=True)
class HeldSides:
    """The sides of a scene that are part of the problem and hold disks."""

    scene: DiskScene

    @cached_property
    def names(self) -> list[str]:
        """All sides of the problem itself that hold disks, at rest or as a wave moves."""
        return [side for side in SIDES if self._holds(side)]

    @property
    def among_others(self) -> list[str]:
        """Sides at rest that hold disks and meet other waves than plane ones along their normal."""
        case = self.scene.case
        return [side for side in self.names if side not in case.driving and not self._meets_only_plane_waves(side)]

    @property
    def driven_under_loads(self) -> list[str]:
        """Driven sides that meet waves of loads, too, whose early return has no formula."""
        is_loaded = any(load.wave for load in self.scene.case.load)
        return [side for side in self.names if side in self.scene.case.driving and is_loaded]

    def causes(self, motions: Motions) -> Iterator[Cause]:
        """The errors of held sides that reflect plane waves, by formula."""
        for side in self.names:
            if self.scene.ground.is_layered and side in self.scene.case.driving:
                reason = "how much earlier the waves that layers send back return from its disks"
                yield Cause.unknown(f"{side} side", reason, True)
            elif self._returns_plane_waves(side):
                parts = {name: self._of_plane_waves(own, side) for name, own in motions.items()}
                words = "by plane waves that come back from disks that are held at their centres"
                yield Cause(f"{side} side", words, parts, of_disks=True, factor=USUAL)

    def _prescribed(self, side: str) -> tuple[int, ...]:
        return self.scene.case.side(side).prescribed(normal_axis(side))

    def _holds(self, side: str) -> bool:
        moving = {0, 1} - {*self.scene.ground.held}
        return bool(moving & {*self._prescribed(side)}) and not self.scene.case.side(side).is_artificial

    def _returns_plane_waves(self, side: str) -> bool:
        """Whether plane waves run between a side and the opposite one, and its error is not found with companions."""
        if side in self.among_others:
            return False
        return any(not self.scene.case.side(OPPOSITE[driven]).is_artificial for driven in self._driven(side))

    def _meets_only_plane_waves(self, side: str) -> bool:
        """Whether all waves enter at a side or its opposite of uniform ground, or are such as it does not hold."""
        case = self.scene.case
        if self.scene.ground.is_layered:
            return False
        if not case.driving or case.incident is not None or case.holes or any(load.wave for load in case.load):
            return False
        axis, held = normal_axis(side), {*self._prescribed(side)}
        return all(
            normal_axis(driven) == axis or not held & {axis_of_motion(driven, motion) for motion in waves}
            for driven, waves in case.driving.items()
        )

    def _driven(self, side: str) -> list[str]:
        """The driven sides among a side and the opposite one."""
        return [each for each in (side, OPPOSITE[side]) if each in self._entries]

    @cached_property
    def _entries(self) -> dict[str, dict[Motion, Entry]]:
        return entries_of(self.scene)

    @cached_property
    def _depths(self) -> dict[str, dict[Motion, float]]:
        return {side: depths_held(self.scene, side) for side in self.names}

    def reflects(self, side: str, motion: Motion) -> float:
        """Reflection coefficient (velocity) of waves along the normal: ±1 of sides that reflect all, 0 of others."""
        table = self.scene.case.side(side)
        if table.is_artificial or table.factors:
            return 0.0
        held = motion == "p" if table.is_mirror else axis_of_motion(side, motion) in self._prescribed(side)
        return -1.0 if held else 1.0

    def _of_plane_waves(self, own: History, side: str) -> dict[str, np.ndarray]:
        """Error of plane waves between a side and the opposite one by the depth of the side."""
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for driven in self._driven(side):
            for motion, entry in self._entries[driven].items():
                if motion in self._depths[side]:
                    self._add_plane_wave(errors, own, side, driven, motion, entry)
        return errors

    def _add_plane_wave(
        self, errors: dict[str, np.ndarray], own: History, side: str, driven: str, motion: Motion, entry: Entry
    ) -> None:
        """Add the error by the depth of `side` of a wave that enters at the side `driven`."""
        axis, far, case = normal_axis(driven), OPPOSITE[driven], self.scene.case
        column, wave = axis_of_motion(driven, motion), case.wave[case.driving[driven][motion]]
        early, round_trip = (2.0 * way / entry.speed for way in (self._depths[side][motion], case.size[axis]))
        to_monitor = abs(float(own.place[axis]) - plane_of(driven, case.box)) / entry.speed
        back = self.reflects(far, motion)
        again = back * self.reflects(driven, motion)
        trips = int((own.time[-1] - own.time[0]) / max(round_trip - early, early)) if again else 0
        for quantity, total in errors.items():
            arriving = wave.velocity if quantity == "velocity" else wave.displacement
            for k in range(1 + trips):
                for share, way, times in ((1.0, to_monitor, k), (back, round_trip - to_monitor, k + (side == far))):
                    time = own.time - entry.delay - way - k * round_trip
                    total[:, column] += again**k * share * (arriving(time + times * early) - arriving(time))


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
            if self.scene.case.holes or self.scene.case.load or table.dashpots_alone() != table:
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
    # without dashpots none comes in
    in_phase = share.dashpots / (1.0 - share.dashpots) if share.dashpots < 1.0 else 0.0
    both = in_phase * velocity + lag * acceleration, in_phase * displacement + lag * velocity
    return dict(zip(MOTIONS, both, strict=True))


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

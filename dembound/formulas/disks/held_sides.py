"""Waves that return early from sides of the problem itself that hold disks at their centres.

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

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries import SIDES, Motion, axis_of_motion, normal_axis
from dembound.boundaries.edge import OPPOSITE, plane_of
from dembound.disks.scene import DiskScene
from dembound.formulas.cause import MOTIONS, USUAL, Cause
from dembound.formulas.disks.entry import Entry, depths_held, entries_of
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
        if not case.driving or case.incident is not None or case.hole or any(load.wave for load in case.load):
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

    def _of_plane_waves(self, own: History, side: str) -> dict[str, np.ndarray | float]:
        """Error of plane waves between a side and the opposite one by the depth of the side."""
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for driven in self._driven(side):
            for motion, entry in self._entries[driven].items():
                if motion in self._depths[side]:
                    self._add_plane_wave(errors, own, side, driven, motion, entry)
        return dict(errors)

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

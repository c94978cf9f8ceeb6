"""Causes of the error of a run of disks: its artificial sides, the dispersion of the packing, and the time step."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.boundaries.sides import OPPOSITE
from dembound.casefile.disks import DiskCase
from dembound.disks.continuum_facts import expected_error
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.disks.wave_front import slowest_speed
from dembound.errors import DemboundError
from dembound.exact.dispersion import Lattice
from dembound.motion.paths import Source
from dembound.studies.estimate.causes import GRID, SIDES, STEP, Cause, Causes, Recorded
from dembound.studies.estimate.delays import Delay, error_of_delay
from dembound.studies.estimate.matched_sides import reflected
from dembound.studies.estimate.pair import Pair, run_pair

MOTIONS = ("velocity", "displacement")
"""Quantities of disks."""


def causes_of_disks(
    case: DiskCase, recorded: Mapping[str, Recorded], time_step: float, work: float, most: float
) -> Causes:
    """The causes of the error of a run, with histories at the recorded times.

    case : to the end of the run. recorded : by monitor. time_step (s), work (particle-steps) : of the run. most :
    particle-steps that may be spent.
    """
    return _Disks(case, build(case), recorded, time_step, work, most).causes()


def causes_by_formula(
    case: DiskCase, scene: DiskScene, recorded: Mapping[str, Recorded], time_step: float
) -> list[Cause]:
    """The same but for sides that are compared by runs; the recorded run may be another one than that of the case.

    scene, time_step (s) : of the case.
    """
    return _Disks(case, scene, recorded, time_step, 0.0, 0.0).by_formula()


@dataclass
class _Disks:
    """The estimate of one run."""

    case: DiskCase
    scene: DiskScene
    recorded: Mapping[str, Recorded]
    time_step: float
    work: float
    most: float

    def causes(self) -> Causes:
        """All causes."""
        return Causes(self.by_formula()) + self._pair()

    def by_formula(self) -> list[Cause]:
        """Those without the sides that are compared by runs."""
        return [*self._sides(), *self._delays()]

    def _pair(self) -> Causes:
        """The errors of sides that absorb, from a pair of runs."""
        artificial = [
            side for side, table in self.case.boundary.items() if table.is_artificial and not table.is_outside
        ]
        if not set(artificial) - set(self.case.driving):
            return Causes([])
        if self.case.ground.size is not None or self.case.incident is not None:
            reason = "beside a continuum no pair of runs is made"
            return Causes([], [f"{' and '.join(artificial)}: {reason}"])
        try:
            pair = run_pair(self.case, self.scene, self.time_step, self.most)
        except DemboundError as error:
            return Causes([], [f"sides: {'; '.join(str(error).splitlines())}"])
        errors = {
            name: {quantity: pair.difference(own, name, quantity) for quantity in MOTIONS}
            for name, own in self.recorded.items()
            if name in pair.own
        }
        cause = Cause(SIDES, self._how(pair), errors)
        notes = [] if pair.echo_free else [f"{SIDES}: the larger scene, {_size(pair)}, has echoes of its own"]
        return Causes([cause], [], notes, pair.work / self.work, echo_free=pair.echo_free)

    def _how(self, pair: Pair) -> str:
        """How the pair was made, in words."""
        return (
            f"from a companion with {pair.ratio:.3g}× larger particles, {_size(pair)}, "
            f"{100.0 * pair.work / self.work:.2g} % of the work of this run"
        )

    def _sides(self) -> Iterator[Cause]:
        """The errors of sides beyond which there is a continuum, and of those that waves enter through."""
        if self.scene.outside is not None and (size := expected_error(self.scene)) is not None:
            same = {name: dict.fromkeys(MOTIONS, size) for name in self.recorded}
            yield Cause("continuum", "by the formulas of its elements, layers and ties", same)
        for side, waves in self.case.driving.items():
            table = self.case.side(side)
            if not table.is_artificial or table.is_outside or not table.factors:
                continue
            shares = reflected(self.scene, side, self.time_step)
            errors = {name: self._returned(own, side, waves, shares) for name, own in self.recorded.items()}
            yield Cause(f"{side} side", "by the reflection of its dashpots at normal incidence", errors)

    def _returned(
        self, own: Recorded, side: str, waves: Mapping[Motion, str], shares: Mapping[Motion, float]
    ) -> dict[str, np.ndarray | float]:
        """What a driven side sends back of its own waves: the recorded motion again, after the way to the far side.

        Behind that is a free surface or another one that sends back everything, else nothing comes back that counts.
        """
        axis, opposite = normal_axis(side), self.case.side(OPPOSITE[side])
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        if opposite.is_artificial:
            return dict(errors)
        for motion in waves:
            column = axis_of_motion(side, motion)
            speed = self.scene.ground.wave_speeds(axis)[0 if motion == "p" else 1]
            if motion not in shares or not math.isfinite(speed):
                continue
            later = own.time - 2.0 * self.case.size[axis] / speed
            for quantity, error in errors.items():
                values = own.values[quantity][:, column]
                error[:, column] = shares[motion] * np.interp(later, own.time, values, left=0.0)
        return dict(errors)

    def _delays(self) -> Iterator[Cause]:
        """The dispersion of the packing, and of the time step."""
        words = "by the dispersion of plane waves on the way from where waves start"
        whole, grid = (
            {name: self._delayed(own, step) for name, own in self.recorded.items()} for step in (self.time_step, 0.0)
        )
        yield Cause(GRID, words, grid)
        steps = {
            name: {quantity: each - grid[name][quantity] for quantity, each in errors.items()}
            for name, errors in whole.items()
        }
        yield Cause(STEP, words, steps)

    def _delayed(self, own: Recorded, step: float) -> dict[str, np.ndarray]:
        """What dispersion adds with steps of this length (s)."""
        found = [self._with_delay(own, column, step) for column in (0, 1)]
        return {quantity: np.stack([each[k] for each in found], axis=1) for k, quantity in enumerate(MOTIONS)}

    def _with_delay(self, own: Recorded, column: int, step: float) -> tuple[np.ndarray, np.ndarray]:
        """The same of one component."""
        path, speed = self._way(own, column)
        if not math.isfinite(path * speed):
            return np.zeros_like(own.time), np.zeros_like(own.time)
        delay = delay_on(Lattice(1, self.scene.ground.brick.mean_diameter, step, speed), path)
        velocity, displacement = error_of_delay(own.time, own.values["velocity"][:, [column]], delay)
        return velocity[:, 0], displacement[:, 0]

    @cached_property
    def _sources(self) -> list[Source]:
        """Where waves start."""
        return sources_of(self.case, self.scene.ground)

    def _way(self, own: Recorded, column: int) -> tuple[float, float]:
        """Length (m) of the way to a monitor, and speed (m/s) of the waves that move it along x or y."""
        sources, ground = self._sources, self.scene.ground
        driven = [side for side in self.case.driving]
        if driven and not any(load.wave for load in self.case.load):
            axis = normal_axis(driven[0])
            speed = ground.wave_speeds(axis)[0 if column == axis else 1]
            return max(float(each.distance(own.position[None])[0]) for each in sources if not each.is_local), speed
        ways = [float(each.distance(own.position[None])[0]) for each in sources]
        return min(ways, default=math.nan), slowest_speed(ground)


def delay_on(lattice: Lattice, path: float) -> Delay:
    """Delay (s) of waves of given angular frequencies (rad/s) on a row of particles over a path (m)."""

    def delay(omega: np.ndarray) -> np.ndarray:
        highest = lattice.shortest
        wavenumber = np.linspace(0.0, highest, 4001)[1:]
        frequency = lattice.frequency(wavenumber)
        known = np.isfinite(frequency)
        slowness = np.concatenate([[1.0 / lattice.wave_speed], wavenumber[known] / frequency[known]])
        at = np.concatenate([[0.0], frequency[known]])
        found = np.interp(omega, at, slowness, right=np.nan)
        return np.asarray(path * (found - 1.0 / lattice.wave_speed))

    return delay


def _size(pair: Pair) -> str:
    return "{:.4g} m × {:.4g} m".format(*pair.size)

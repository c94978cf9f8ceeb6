"""Causes of the error of a run of disks: its artificial sides, the dispersion of the packing, and the time step."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.accuracy.cause import CONTINUUM, GRID, SIDES, STEP, Cause, Causes
from dembound.accuracy.delays import error_of_delay
from dembound.accuracy.history import History, Motions
from dembound.accuracy.of_disks.matched_sides import Reflected, reflected
from dembound.accuracy.of_disks.near import wall_error
from dembound.accuracy.of_disks.pair import Pair, run_pair, sides_of_pair
from dembound.accuracy.of_disks.waves import AXES, DIAGONAL, Direction, delay_of
from dembound.accuracy.runner import Runner
from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.boundaries.sides import OPPOSITE
from dembound.casefile.disks import DiskCase
from dembound.disks.reports.continuum_errors import expected_errors
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.errors import DemboundError
from dembound.motion.paths import Source
from dembound.results.estimates import in_words

MOTIONS = ("velocity", "displacement")
"""Quantities of disks."""


def causes_of_disks(case: DiskCase, recorded: Motions, time_step: float, work: float, most: float) -> Causes:
    """The causes of the error of a run, with histories at the recorded times.

    case : to the end of the run. recorded : by monitor. time_step (s), work (particle-steps) : of the run. most :
    particle-steps that may be spent.
    """
    return _Disks(case, build(case), recorded, time_step, work, most).causes()


def causes_by_formula(case: DiskCase, scene: DiskScene, recorded: Motions, time_step: float) -> list[Cause]:
    """Causes of the error of a case that are known without runs: all but sides that absorb and let no waves in.

    scene, time_step (s) : of the case. recorded : motion at its monitors, also of another run.
    """
    return _Disks(case, scene, recorded, time_step, 0.0, 0.0).by_formula()


@dataclass
class _Disks:
    """The estimate of one run."""

    case: DiskCase
    scene: DiskScene
    recorded: Motions
    time_step: float
    work: float
    most: float

    def causes(self) -> Causes:
        """All causes."""
        return Causes(self.by_formula(), [*self._edge_disks(), *self._without_formula()]) + self._pair()

    def by_formula(self) -> list[Cause]:
        """Causes of errors that formulas give, without the sides that runs are compared for."""
        return [*self._sides(), *self._delays()]

    def _edge_disks(self) -> Iterator[str]:
        """Monitors at absorbing sides of random packings, or at uneven ones, of whose disks nothing is known."""
        packing = self.case.packing
        reach, box = 2.0 * self.scene.ground.brick.mean_diameter, packing.box
        edges = {side: box[k] for k, side in enumerate(("left", "bottom", "right", "top"))}
        at = [
            name
            for name, own in self.recorded.items()
            for side, table in self.case.boundary.items()
            if not (packing.is_lattice and side in packing.regular_sides)
            and table.factors
            and abs(own.place[normal_axis(side)] - edges[side]) < reach
        ]
        if at:
            names = " and ".join(dict.fromkeys(at))
            edge = "an uneven edge" if packing.is_lattice else "the edge of a random packing"
            yield f"how single disks at {edge} move otherwise than those around, at {names}"

    def _without_formula(self) -> Iterator[str]:
        """Causes for which a formula needs more than the case has."""
        if self.scene.outside is not None and expected_errors(self.scene, {}) is None:
            yield "continuum: its elements are judged by the highest frequency of waves, and a wave that jumps has none"
        if not any(self._ways(own) for own in self.recorded.values()):
            yield "grid and time step: waves start everywhere"
        for side in self.case.driving:
            table = self.case.side(side)
            if table.is_artificial and not table.absorbs:
                yield f'{side} side: "{table.type}" has no dashpots, by which its reflection would be known'
        if self.case.hole:
            size = in_words(wall_error(self.case, self.scene.ground.brick.mean_diameter))
            yield f"walls of holes, which consist of disks: up to some {size} beside them"

    def _pair(self) -> Causes:
        """The errors of sides that absorb, from a pair of runs."""
        sides = sides_of_pair(self.case)
        if not sides:
            return Causes([])
        if self.case.ground.size is not None or self.case.incident is not None:
            reason = "beside a continuum no pair of runs is made"
            return Causes([], [f"{' and '.join(sides)}: {reason}"])
        try:
            pair = run_pair(self.case, self.scene, self.time_step, self.most, Runner())
        except DemboundError as error:
            return Causes([], [f"sides: {'; '.join(str(error).splitlines())}"])
        errors = {
            name: {quantity: pair.difference(own, name, quantity) for quantity in MOTIONS}
            for name, own in self.recorded.items()
            if name in pair.runs[0].motions
        }
        cause = Cause(SIDES, self._how(pair), errors)
        notes = [] if pair.echo_free else [f"{SIDES}: the larger scene, {_size(pair)}, has echoes of its own"]
        return Causes([cause], [], notes, pair.work / self.work, echo_free=pair.echo_free)

    def _how(self, pair: Pair) -> str:
        """How the pair was made, in words."""
        return (
            f"from a companion with particles {pair.ratio:.3g} times as large, {_size(pair)}, "
            f"{in_words(pair.work / self.work)} of the work of this run"
        )

    def _sides(self) -> Iterator[Cause]:
        """The errors of sides beyond which there is a continuum, and of those that waves enter through."""
        places = {name: own.place for name, own in self.recorded.items()}
        if (sizes := expected_errors(self.scene, places)) is not None:
            yield Cause(
                CONTINUUM,
                "by the formulas of its elements, layers and ties",
                {name: dict(zip(MOTIONS, each, strict=True)) for name, each in sizes.items()},
            )
        for side, waves in self.case.driving.items():
            table = self.case.side(side)
            if not table.factors:
                continue
            shares = reflected(self.scene, side, self.time_step)
            errors = {name: self._returned(own, side, waves, shares) for name, own in self.recorded.items()}
            yield Cause(f"{side} side", "by the reflection of dashpots at normal incidence", errors)

    def _returned(
        self, own: History, side: str, waves: Mapping[Motion, str], shares: Mapping[Motion, Reflected]
    ) -> dict[str, np.ndarray | float]:
        """What a driven side keeps back of its waves, and sends back of what returns to it.

        A side that reflects R lets 1 − R of its wave in. What is sent back is the motion again, after the way to the
        far side, if that is a free surface or another one that sends back everything; else nothing comes back that
        counts.
        """
        axis, far = normal_axis(side), self.case.side(OPPOSITE[side])
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for motion in waves:
            column = axis_of_motion(side, motion)
            speed = self.scene.ground.wave_speeds(axis)[0 if motion == "p" else 1]
            if motion not in shares or not math.isfinite(speed):
                continue
            later = own.time - 2.0 * self.case.size[axis] / speed
            sent = reflected_motion(own, column, shares[motion])
            for quantity, values in sent.items():
                back = 0.0 if far.is_artificial else np.interp(later, own.time, values, left=0.0)
                errors[quantity][:, column] = back - values
        return dict(errors)

    def _delays(self) -> Iterator[Cause]:
        """The dispersion of the packing, and of the time step."""
        if not any(self._ways(own) for own in self.recorded.values()):
            return
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

    def _delayed(self, own: History, step: float) -> dict[str, np.ndarray]:
        """What dispersion adds with steps of this length (s)."""
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for way in self._ways(own):
            if not math.isfinite(way.path * way.speed):
                continue
            delay = delay_of(self.scene.ground, way.motion, way.directions, way.path, way.speed, step)
            parts = error_of_delay(own.time, (own.values["velocity"] @ way.moves)[:, None], delay)
            for quantity, part in zip(MOTIONS, parts, strict=True):
                errors[quantity] += part * way.moves
        return errors

    @cached_property
    def _sources(self) -> list[Source]:
        """Where waves start."""
        return sources_of(self.case, self.scene.ground)

    def _ways(self, own: History) -> list[_Way]:
        """The ways of P and S waves to a monitor: from a driven side, or from the nearest load or hole.

        A wave at an angle comes through a continuum, which delays it less: its way is the longer side of the disks.
        None where waves start everywhere.
        """
        sources, ground = self._sources, self.scene.ground
        driving = list(self.case.driving)
        if driving and not any(load.wave for load in self.case.load):
            axis = normal_axis(driving[0])
            path = max(float(each.distance(own.place[None])[0]) for each in sources if not each.is_local)
            if not self.case.side(OPPOSITE[driving[0]]).is_artificial:
                path = self.case.size[axis]  # the mean of the ways there, and back from the other side
            return _both_ways(np.eye(2)[axis], path, ground.wave_speeds(axis), [AXES[axis]])
        if self.case.incident is not None:
            extent = self.case.packing.extent
            return _both_ways(np.eye(2)[1], max(extent), ground.wave_speeds(1), [AXES[0], DIAGONAL])
        local = [each for each in sources if np.isfinite(each.box).all()]
        places = [np.clip(own.place, each.box[:2], each.box[2:]) for each in local]
        rays = [own.place - place for place in places]
        if not rays:
            return []
        ray = min(rays, key=lambda each: float(np.hypot(*each)))
        path, axis = float(np.hypot(*ray)), int(np.argmax(np.abs(ray)))
        along = ray / path if path > 0.0 and not {0, 1} & set(ground.held) else np.eye(2)[axis]
        return _both_ways(along, path, ground.wave_speeds(axis), [AXES[0], DIAGONAL])


@dataclass(frozen=True)
class _Way:
    """The way of a kind of waves.

    motion : of the waves. moves : (2,) unit vector along which they move disks. path : m. speed : m/s, of long waves.
    directions : in which they may run.
    """

    motion: Motion
    moves: np.ndarray
    path: float
    speed: float
    directions: Sequence[Direction]


def _both_ways(
    along: np.ndarray, path: float, speeds: tuple[float, float], directions: Sequence[Direction]
) -> list[_Way]:
    """The ways of P and S waves, of these speeds (m/s), along a unit vector."""
    across = np.array([-along[1], along[0]])
    p, s = speeds
    return [_Way("p", along, path, p, directions), _Way("s", across, path, s, directions)]


def reflected_motion(own: History, column: int, share: Reflected) -> dict[str, np.ndarray]:
    """Velocity and displacement (k,) that a side reflects of a recorded motion along x or y (column 0 or 1).

    In phase R/(1 − R) of the motion, as 1 − R of it has come in; what is out of phase has the shape of a mass's force,
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


def _size(pair: Pair) -> str:
    return "{:.4g} m × {:.4g} m".format(*pair.size)

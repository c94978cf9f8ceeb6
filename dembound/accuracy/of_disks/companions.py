"""Runs with larger disks that show effects of sides on the motion of the monitors: with far sides, and with others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dembound.accuracy.judge import movable
from dembound.accuracy.of_disks.coarser import Coarser, coarser
from dembound.accuracy.of_disks.enlarged import Pair, bricks_needed, enlarged, pair_of, ratios, sides_of_pair
from dembound.accuracy.runner import Run, Runner, at_step
from dembound.boundaries import is_far, normal_axis
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.symmetry import Symmetry
from dembound.casefile.disks import DiskCase
from dembound.disks.contacts.pairs import BREAK_TIME
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError, RunError
from dembound.formulas.disks.held_sides import HeldSides
from dembound.formulas.disks.places import middle_of_loads, patch_around, weights_at
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.history import History, Motions
from dembound.motion.kind import StalledError
from dembound.packings import Packing
from dembound.words import with_unit

QUANTITIES = ("velocity", "displacement")
"""Quantities whose errors are bounded."""

LESS = 0.9
"""Step of all companions over that of the pair, so that it is stable with the springs and half cells of any sides."""


@dataclass
class Companions:
    """Companions of a case of disks.

    case, scene, time_step (s) : of the given case. most : particle-steps that the first two may take. runner : runs
    them. reflections : of sides, measured before.
    """

    case: DiskCase
    scene: DiskScene
    time_step: float
    most: float
    runner: Runner = field(default_factory=Runner)
    reflections: Reflections = field(default_factory=Reflections, repr=False)
    _made: dict[tuple[str, float], Coarser] = field(default_factory=dict, init=False, repr=False)
    _behind: dict[str, Motions] = field(default_factory=dict, init=False, repr=False)
    _mirrored: dict[str, Motions] = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def pair(self) -> Pair | None:
        """The scenes with the case's own sides and with far ones; None where no side that reflects can move."""
        if self.case.ground.size is not None or not sides_of_pair(self.case):
            return None
        return pair_of(self.case, self.scene, self.time_step, self.most, self.reflections)

    @cached_property
    def diameter(self) -> float:
        """Largest diameter of their disks, m."""
        ratio = ratios(self.case, self.scene)[-1] if self.pair is None else self.pair.ratio
        return ratio * self.scene.ground.brick.mean_diameter

    @cached_property
    def step(self) -> float:
        """Time step of all of them, s."""
        if self.pair is not None:
            return LESS * self.pair.step
        return LESS * choose_step(self.lattice)[0]

    @property
    def size(self) -> str:
        """The sizes of the first companions, in words."""
        each = dict.fromkeys(f"{scene.disk_count:,} disks × {steps:,} steps" for scene, steps in self.first)
        return " and ".join(each)

    @cached_property
    def first(self) -> list[tuple[DiskScene, int]]:
        """Scenes of the first companions, that with the sides of the case before others, and their steps."""
        scenes = [self.lattice] if self.pair is None else self.pair.scenes
        return [(scene, math.ceil(self.case.run.duration / self.step)) for scene in scenes]

    @property
    def far(self) -> Motions:
        """The motion of the disks of all patches without reflections of sides, until bonds break."""
        return self._until_break(self._far.motions)

    @property
    def first_break(self) -> float:
        """Time (s) at which the first bond breaks in the run with far sides, infinite without one."""
        return self._far.finding(BREAK_TIME)

    def _until_break(self, motions: Motions) -> Motions:
        """The histories, cut before the first bond breaks with far sides."""
        return {name: each.before(self.first_break) for name, each in motions.items()}

    @cached_property
    def _far(self) -> Run:
        """The run with far sides."""
        return self._measured(self._with_far_sides(self.own), "far sides" if self.pair else "larger disks")

    def _with_far_sides(self, case: DiskCase) -> DiskCase:
        """A companion with its sides so far away that nothing returns, if they may move."""
        return case if self.pair is None else enlarged(build(case), self.pair.bricks)

    @cached_property
    def lattice(self) -> DiskScene:
        """The scene of the given case with larger disks."""
        if self.pair is not None:
            return self.pair.smaller
        return build(self._coarser(self.case, self.scene, self.time_step).case)

    @cached_property
    def _patches(self) -> dict[str, np.ndarray]:
        """By monitor, the places (k, 2) m of the disks around it in the scene with larger disks."""
        return {name: patch_around(self.lattice, place) for name, place in self.places_of(self.scene).items()}

    @cached_property
    def own(self) -> DiskCase:
        """The given case with larger disks, and monitors at the disks of all patches."""
        case = self.lattice.case
        given = {monitor.name: monitor for monitor in case.monitor}
        monitors = tuple(
            given[name].model_copy(update={"name": _named(name, k), "position": tuple(place)})
            for name, patch in self._patches.items()
            for k, place in enumerate(patch.tolist())
        )
        return replace(case, monitor=monitors)

    @cached_property
    def _needed(self) -> dict[str, int]:
        """By side that may move, the bricks of larger disks beyond it with which nothing returns."""
        return needed_by(build(self.own))

    @property
    def echo_free(self) -> bool:
        """Whether nothing returns in the run with far sides."""
        return self.pair is None or self.pair.echo_free

    @property
    def far_size(self) -> str:
        """Width and height of the scene with far sides, in words."""
        size = self.lattice.case.size if self.pair is None else self.pair.size
        return "{:.4g} m × {:.4g} m".format(*size)

    @property
    def words(self) -> str:
        """How errors are found with companions, in words."""
        ratio = self.diameter / self.scene.ground.brick.mean_diameter
        return f"from companions with particles {ratio:.3g} times as large, {self.far_size}"

    def recorded(self, scene: DiskScene) -> dict[str, History]:
        """The far companion's motion at the places of a scene's monitors relative to the loads."""
        time = next(iter(self.far.values())).time
        motion = self.motion_at(self.far, self.places_of(scene))
        return {name: History(scene.monitored[name], time, values) for name, values in motion.items()}

    def with_mirror_at(self, side: str) -> Motions:
        """The motion of the disks of all patches with far sides and a mirror plane at a side that stays."""
        if side not in self._mirrored:
            sides = {**self.own.boundary, side: Symmetry(type="symmetry")}
            case = self._with_far_sides(replace(self.own, boundary=sides))
            self._mirrored[side] = self._run(case, f"a mirror plane at {side}")
        return self._mirrored[side]

    def with_row_at(self, side: str) -> Motions:
        """The motion of the disks of all patches with far sides and one more row of disks at a side that stays."""
        if side not in self._behind:
            own, axis = self.own, normal_axis(side)
            copies, origin = list(own.packing.copies), list(own.packing.origin)
            copies[axis] += 1
            origin[axis] -= 0.0 if is_far(side) else own.packing.brick_size[axis]
            packing = own.packing.with_copies(*copies).model_copy(update={"origin": tuple(origin)})
            case = self._with_far_sides(replace(own, packing=packing))
            self._behind[side] = self._run(case, f"one more row at {side}")
        return self._behind[side]

    def places_of(self, scene: DiskScene) -> dict[str, np.ndarray]:
        """By monitor of a scene, its place (2,) m in the companion's lattice, relative to the middle of loads."""
        seen, own = (middle_of_loads(each) for each in (scene, self.lattice))
        low, stretch = np.array(self.case.box[:2]), np.array(self.lattice.case.size) / self.case.size
        names = [monitor.name for monitor in self.case.monitor]
        if seen is None or own is None:
            return {name: low + (scene.monitored[name] - low) * stretch for name in names}
        return {name: own + scene.monitored[name] - seen for name in names}

    def motion_at(self, motions: Motions, places: Mapping[str, np.ndarray]) -> dict[str, dict[str, np.ndarray]]:
        """Motion (k, 2) along x and y at places (2,) m near the monitors, by monitor and quantity."""
        found: dict[str, dict[str, np.ndarray]] = {}
        for name, patch in self._patches.items():
            weights = weights_at(patch, places[name])
            disks = [motions[_named(name, k)] for k in range(len(patch))]
            found[name] = {q: np.zeros((len(disks[0].time), 2)) for q in QUANTITIES}
            for weight, history in zip(weights, disks, strict=True):
                for q, motion in found[name].items():
                    motion += weight * history.values[q][:, :2]
        return found

    def of_sides(
        self, case: DiskCase, scene: DiskScene, time_step: float, wider: float
    ) -> dict[str, dict[str, np.ndarray | float]]:
        """Errors (k, 2) of sides at a scene's monitors, by monitor and quantity.

        wider : distance of the sides beyond their place in the case, over the scene's length across them.
        """
        given = self._coarser(case, scene, time_step)
        own = self._with_sides(given.case.boundary, scene, wider)
        whole = self._with_sides(given.with_whole_cells.boundary, scene, wider) if given.weight > 0.0 else own
        far = self.motion_at(self.far, self.places_of(scene))
        return {
            name: {q: own[name][q] - far[name][q] + given.weight * (whole[name][q] - own[name][q]) for q in QUANTITIES}
            for name in far
        }

    def _coarser(self, case: DiskCase, scene: DiskScene, time_step: float) -> Coarser:
        """The case with disks of the companion, made once for all distances of its sides."""
        key = case.text, time_step
        if self.pair is not None:
            self._made.setdefault((self.case.text, self.time_step), self.pair.given)
        if key not in self._made:
            self._made[key] = coarser(case, scene, time_step, self.diameter, self.reflections)
        return self._made[key]

    def _with_sides(
        self, sides: Mapping[str, Boundary], scene: DiskScene, wider: float
    ) -> dict[str, dict[str, np.ndarray]]:
        """Motion at a scene's monitors in a companion with given sides, moved outwards by `wider` of its length."""
        own = replace(self.own, boundary=sides)
        case = enlarged(build(own), farther(own.packing, self._needed, wider)) if wider else own
        return self.motion_at(self._run(case, "sides of its own"), self.places_of(scene))

    def _run(self, case: DiskCase, what: str) -> Motions:
        """The motion of the monitors of a companion, until bonds break with far sides."""
        return self._until_break(self._measured(case, what).motions)

    def _measured(self, case: DiskCase, what: str) -> Run:
        """The run of a companion; what : it has, in words. Raises RunError if it does not come to rest."""
        try:
            return self.runner.run(at_step(case, self.step), self.named(f"with {what}"))
        except StalledError as stalled:
            size = with_unit(2.0 * case.packing.radius, "m")
            moved = f"ground of disks of {size} with {what} does not come to rest under its loads"
            raise RunError(f"{moved} ({stalled.run.state.step:,} steps), where the given one did") from None

    @cached_property
    def expected(self) -> int:
        """Number of companions of the case itself, about."""
        own = 1 if self.pair is None else len(self.pair.scenes)
        return own + (2 if self.scene.has_history else 0) + len(HeldSides(self.scene).among_others)

    def named(self, what: str) -> str:
        """The next companion, in words."""
        number = self.runner.count + 1
        of = f" of about {self.expected}" if number <= self.expected else ""
        return f"companion {number}{of}, {what}"


def _named(monitor: str, number: int) -> str:
    """The name of a monitor of a patch."""
    return f"{monitor}.{number}"


def farther(packing: Packing, needed: Mapping[str, int], wider: float) -> dict[str, int]:
    """Bricks by which sides move outwards by `wider` times the length across them.

    needed : by side, the most that it moves, see `needed_by`.
    """
    bricks = {side: math.ceil(wider * packing.copies[normal_axis(side)] - 1e-9) for side in needed}
    return {side: min(count, bricks[side]) for side, count in needed.items()}


def needed_by(scene: DiskScene) -> dict[str, int]:
    """By side that may move, the bricks beyond it with which nothing returns; empty where no side may."""
    try:
        return bricks_needed(scene, movable(scene.case))
    except CaseError:
        return {}

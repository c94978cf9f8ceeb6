"""Runs with larger disks that show effects of sides on the motion of the monitors: with far sides, and with others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from dembound.accuracy.moved_sides import movable
from dembound.accuracy.of_disks.coarser import Coarser, coarser
from dembound.accuracy.of_disks.enlarged import Pair, bricks_needed, enlarged, pair_of, ratios, sides_of_pair
from dembound.accuracy.runner import Run, Runner, at_step
from dembound.boundaries import SIDES, is_far, normal_axis
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.symmetry import Symmetry
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.contacts.pairs import BREAK_TIME
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.formulas.disks.entry import depths_held
from dembound.formulas.disks.held_sides import HeldSides
from dembound.formulas.disks.places import middle_of_loads, patch_around, places_of_loads, weights_at
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.waves import is_square_lattice
from dembound.formulas.history import History, Motions
from dembound.packings import Packing

QUANTITIES = ("velocity", "displacement")
"""Quantities whose errors are bounded."""

LEEWAY = 1.5
"""Work of the cheapest pair over what may be spent, from which on an estimate runs none."""

LEAST_SHIFT = 1e-6
"""Shift of a load, over the diameter of companions, from which on its way to surfaces counts."""

LESS = 0.9
"""Step of all companions over that of the pair, so that it is stable with the springs and half cells of any sides."""

OFTEN = 3.0
"""Work of a run and of one with half its step, over the work of the run."""

OF_LARGER = 2.2
"""Errors of the time step where contacts open or slide, over those of disks 1.6 times as large: 0.3 to 4.6 times (30
velocities)."""


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
        return LESS * choose_step(self._lattice)[0]

    def require_affordable(self) -> None:
        """Raise CaseError if even the cheapest pair takes much more than may be spent."""
        if self.pair is not None and (times := self.pair.work / self.most) > LEEWAY:
            raise CaseError([f"companions would take {times:.2g} times the work that may be spent on them"])

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
        return self._measured(self._with_far_sides(self._own), "far sides" if self.pair else "larger disks")

    def _with_far_sides(self, case: DiskCase) -> DiskCase:
        """A companion with its sides so far away that nothing returns, if they may move."""
        return case if self.pair is None else enlarged(build(case), self.pair.bricks)

    @cached_property
    def _lattice(self) -> DiskScene:
        """The scene of the given case with larger disks."""
        if self.pair is not None:
            return self.pair.smaller
        return build(self._coarser(self.case, self.scene, self.time_step).case)

    @cached_property
    def _patches(self) -> dict[str, np.ndarray]:
        """By monitor, the places (k, 2) m of the disks around it in the scene with larger disks."""
        return {name: patch_around(self._lattice, place) for name, place in self._places(self.scene).items()}

    @cached_property
    def _own(self) -> DiskCase:
        """The given case with larger disks, and monitors at the disks of all patches."""
        case = self._lattice.case
        monitors = {monitor.name: monitor for monitor in case.monitor}
        return replace(
            case,
            monitor=tuple(
                monitors[name].model_copy(update={"name": _named(name, k), "position": tuple(place)})
                for name, patch in self._patches.items()
                for k, place in enumerate(patch.tolist())
            ),
        )

    @cached_property
    def _needed(self) -> dict[str, int]:
        """By side that may move, the bricks of larger disks beyond it with which nothing returns."""
        return needed_by(build(self._own))

    @property
    def echo_free(self) -> bool:
        """Whether nothing returns in the run with far sides."""
        return self.pair is None or self.pair.echo_free

    @property
    def far_size(self) -> str:
        """Width and height of the scene with far sides, in words."""
        size = self._lattice.case.size if self.pair is None else self.pair.size
        return "{:.4g} m × {:.4g} m".format(*size)

    @property
    def words(self) -> str:
        """How errors are found with companions, in words."""
        ratio = self.diameter / self.scene.ground.brick.mean_diameter
        return f"from companions with particles {ratio:.3g} times as large, {self.far_size}"

    def recorded(self, scene: DiskScene) -> dict[str, History]:
        """The far companion's motion at the places of a scene's monitors relative to the loads."""
        time = next(iter(self.far.values())).time
        motion = self._motion(self.far, self._places(scene))
        return {name: History(scene.monitored[name], time, values) for name, values in motion.items()}

    def moved(self, scene: DiskScene) -> dict[str, dict[str, np.ndarray | float]]:
        """Error (k, 2) by monitors and loads that are not at the requested places, by monitor and quantity.

        Monitors and loads act at the nearest disks. Of several loads, of whose motion only the sum is known, the one
        with the largest error counts. A load at another place also has other distances from surfaces, from which its
        waves return earlier or later.
        """
        there, asked, loads = self._places(scene), _asked(self.case, scene), _shifts_of_loads(scene)
        own = self._motion(self.far, there)
        each = [self._unmoved({name: there[name] + asked[name] + load for name in there}, load) for load in loads]
        return {
            name: {q: max((own[name][q] - other[name][q] for other in each), key=np.linalg.norm) for q in QUANTITIES}
            for name in own
        }

    def _unmoved(self, places: Mapping[str, np.ndarray], shift: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
        """Motion (k, 2) at places (2,) m, by monitor, before they and the loads were shifted relative to fixed sides.

        shift : (2,) m. To the first order, from the change by one more row of disks at these sides.
        """
        far, cell = self._motion(self.far, places), self._lattice.ground.brick.mean_diameter
        found = {name: dict(own) for name, own in far.items()}
        for side in filter(partial(_stays, self.case), SIDES):
            towards = float(shift[normal_axis(side)]) * (1.0 if is_far(side) else -1.0) / cell
            if abs(towards) < LEAST_SHIFT:
                continue
            away = self._motion(self._with_row_at(side), places)
            for name, own in far.items():
                for q, values in own.items():
                    found[name][q] = found[name][q] + towards * (away[name][q] - values)
        return found

    def of_held(self, scene: DiskScene, side: str) -> dict[str, dict[str, np.ndarray | float]]:
        """Error (k, 2) of a side that holds disks at a depth s inside of its plane, by monitor and quantity.

        Companions are lattices, which hold disks of the diameter D' at D'/2. One more row of them puts these as far
        outside of the plane, so that the difference v(D'/2) - v(-D'/2) is the change over D' about the plane. Where
        motion along the side is free, mass begins at the plane and must stay there: a mirror plane holds the same
        components at the plane, and the difference is the change over D'/2. To the first order the error is s over that
        distance times the difference, with the mean s of P and S waves, of which motion is the sum: on a lattice D/2
        and 0.77 D at a fixed side.
        """
        places, table = self._places(scene), self.case.side(side)
        far, cell = self._motion(self.far, places), self._lattice.ground.brick.mean_diameter
        depths = depths_held(scene, side).values()
        if {0, 1} & {*table.prescribed(normal_axis(side))} == {normal_axis(side)}:
            other, way = self._with_mirror_at(side), 0.5 * cell
        else:
            other, way = self._with_row_at(side), cell
        there = self._motion(other, places)
        share = sum(depths) / (len(depths) * way)
        return {name: {q: share * (own[q] - there[name][q]) for q in QUANTITIES} for name, own in far.items()}

    def of_steps(self, scene: DiskScene, time_step: float) -> dict[str, dict[str, np.ndarray | float]]:
        """Error (k, 2) of the time step (s) where contacts open or slide, by monitor and quantity: a random sample.

        A contact opens, slides or closes up to a step late, and others follow, so errors are random and grow with the
        first power of the step: the difference to a run with half the step has √(1 + 1/4) times their RMS. The given
        case is run with both steps if that is affordable, else its companion, whose error scales with the step over its
        limit, which is proportional to the diameter. Empty where the law remains elastic.
        """
        is_own, (case, step), run = self._runs_own, self._with_contacts, self._sliding
        if not any(LAWS[name].has_history for name in run.laws):
            return {}
        shorter = self.runner.run(at_step(case, 0.5 * step), self._named("with half the step"))
        end, time = min(run.finding(BREAK_TIME), shorter.finding(BREAK_TIME)), next(iter(self.far.values())).time
        own, half = ({name: each.at(time) for name, each in one.motions.items()} for one in (run, shorter))
        if is_own:
            found = {name: {q: (own[name].values[q] - half[name].values[q])[:, :2] for q in QUANTITIES} for name in own}
        else:
            with_step, with_half = (self._motion(motions, self._places(scene)) for motions in (own, half))
            found = {name: {q: with_step[name][q] - with_half[name][q] for q in QUANTITIES} for name in with_step}
        diameter = self.scene.ground.brick.mean_diameter if is_own else self.diameter
        times = time_step / step * diameter / scene.ground.brick.mean_diameter / math.sqrt(1.25)
        known = times * (1.0 if is_own else OF_LARGER) * (time < end)[:, None]
        return {name: {q: known * each for q, each in by_quantity.items()} for name, by_quantity in found.items()}

    @property
    def settled(self) -> Mapping[str, Any] | None:
        """Numbers of the static stage, see `describe_static`; None without one, and under laws without history.

        Forces of a companion are in proportion to its diameter. Its lattice may come to rest elastically where contacts
        of a random packing slide, which therefore count as sliding.

        Raises the errors of running the case or its companion.
        """
        if self.case.static is None or not self.scene.has_history:
            return None
        found = self._sliding.settled
        if self._runs_own or found is None:
            return found
        force = found["mean_residual"] * self.scene.ground.brick.mean_diameter / self.diameter
        rests_elastically = found["elastic"] and is_square_lattice(self.scene.ground)
        return {**found, "mean_residual": force, "elastic": rests_elastically}

    @cached_property
    def _runs_own(self) -> bool:
        """Whether the given case itself is run where contacts may open or slide, as that is affordable."""
        return OFTEN * self.scene.count * self.case.run.duration / self.time_step <= self.most

    @property
    def _with_contacts(self) -> tuple[DiskCase, float]:
        """The case or companion that is run where contacts may open or slide, and its step, s."""
        return (self.case, self.time_step) if self._runs_own else (self._own, self.step)

    @property
    def _sliding(self) -> Run:
        """The run where contacts may open or slide."""
        return self.runner.run(at_step(*self._with_contacts), self._named("where contacts open or slide"))

    def _with_mirror_at(self, side: str) -> Motions:
        """The motion of the disks of all patches with far sides and a mirror plane at a side that stays."""
        if side not in self._mirrored:
            sides = {**self._own.boundary, side: Symmetry(type="symmetry")}
            self._mirrored[side] = self._run(
                self._with_far_sides(replace(self._own, boundary=sides)), f"a mirror plane at {side}"
            )
        return self._mirrored[side]

    def _with_row_at(self, side: str) -> Motions:
        """The motion of the disks of all patches with far sides and one more row of disks at a side that stays."""
        if side not in self._behind:
            own, axis = self._own, normal_axis(side)
            copies, origin = list(own.packing.copies), list(own.packing.origin)
            copies[axis] += 1
            origin[axis] -= 0.0 if is_far(side) else own.packing.brick_size[axis]
            packing = own.packing.with_copies(*copies).model_copy(update={"origin": tuple(origin)})
            self._behind[side] = self._run(
                self._with_far_sides(replace(own, packing=packing)), f"one more row at {side}"
            )
        return self._behind[side]

    def _places(self, scene: DiskScene) -> dict[str, np.ndarray]:
        """By monitor of a scene, its place (2,) m in the companion's lattice, relative to the middle of loads."""
        seen, own = (middle_of_loads(each) for each in (scene, self._lattice))
        low, stretch = np.array(self.case.box[:2]), np.array(self._lattice.case.size) / self.case.size
        names = [monitor.name for monitor in self.case.monitor]
        if seen is None or own is None:
            return {name: low + (scene.monitored[name] - low) * stretch for name in names}
        return {name: own + scene.monitored[name] - seen for name in names}

    def _motion(self, motions: Motions, places: Mapping[str, np.ndarray]) -> dict[str, dict[str, np.ndarray]]:
        """Motion (k, 2) along x and y at places (2,) m near the monitors, by monitor and quantity."""
        found: dict[str, dict[str, np.ndarray]] = {}
        for name, patch in self._patches.items():
            weights = weights_at(patch, places[name])
            disks = [motions[_named(name, k)] for k in range(len(patch))]
            found[name] = {
                q: sum(
                    (w * history.values[q][:, :2] for w, history in zip(weights, disks, strict=True)),
                    np.zeros((len(disks[0].time), 2)),
                )
                for q in QUANTITIES
            }
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
        far = self._motion(self.far, self._places(scene))
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
        own = replace(self._own, boundary=sides)
        case = enlarged(build(own), farther(own.packing, self._needed, wider)) if wider else own
        return self._motion(self._run(case, "sides of its own"), self._places(scene))

    def _run(self, case: DiskCase, what: str) -> Motions:
        """The motion of the monitors of a companion, until bonds break with far sides."""
        return self._until_break(self._measured(case, what).motions)

    def _measured(self, case: DiskCase, what: str) -> Run:
        """The run of a companion; what : it has, in words."""
        return self.runner.run(at_step(case, self.step), self._named(f"with {what}"))

    @cached_property
    def expected(self) -> int:
        """Number of companions of the case itself, about."""
        own = 1 if self.pair is None else len(self.pair.scenes)
        return own + (2 if self.scene.has_history else 0) + len(HeldSides(self.scene).among_others)

    def _named(self, what: str) -> str:
        """The next companion, in words."""
        number = self.runner.count + 1
        of = f" of about {self.expected}" if number <= self.expected else ""
        return f"companion {number}{of}, {what}"


def is_moved(scene: DiskScene) -> bool:
    """Whether a monitor or a load that starts waves is at another place than the requested one, but for rounding."""
    shifts = [*_asked(scene.case, scene).values(), *_shifts_of_loads(scene)]
    return bool(np.abs(shifts).max() > LEAST_SHIFT * scene.ground.brick.mean_diameter)


def _asked(case: DiskCase, scene: DiskScene) -> dict[str, np.ndarray]:
    """By monitor, the way (2,) m from its disk in a scene to its place in the case that the scene stands for."""
    return {each.name: np.subtract(each.position, scene.monitored[each.name]) for each in case.monitor}


def _shifts_of_loads(scene: DiskScene) -> list[np.ndarray]:
    """The ways (2,) m from requested to real places of the loads that start waves; one of 0 without such loads."""
    return [each.middle - each.asked for each in places_of_loads(scene)] or [np.zeros(2)]


def _stays(case: DiskCase, side: str) -> bool:
    """Whether a side reflects and cannot move: a surface or the end of a block."""
    table = case.side(side)
    return not (table.is_artificial or table.is_periodic or table.waves)


def _named(monitor: str, number: int) -> str:
    """The name of a monitor of a patch."""
    return f"{monitor}.{number}"


def farther(packing: Packing, needed: Mapping[str, int], wider: float) -> dict[str, int]:
    """Bricks by which sides move outwards by `wider` times the length across them.

    needed : by side, the most that it moves, see `needed_by`.
    """
    return {
        side: min(count, math.ceil(wider * packing.copies[normal_axis(side)] - 1e-9)) for side, count in needed.items()
    }


def needed_by(scene: DiskScene) -> dict[str, int]:
    """By side that may move, the bricks beyond it with which nothing returns; empty where no side may."""
    try:
        return bricks_needed(scene, movable(scene.case))
    except CaseError:
        return {}

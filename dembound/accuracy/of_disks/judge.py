"""Errors of bonded disks, by formulas and by companions of larger disks, and the cheapest choices for bounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import OWN, Choice, Named
from dembound.accuracy.judge import Extended, Judge
from dembound.accuracy.of_disks.affordable import require_short
from dembound.accuracy.of_disks.candidates import CUT, LONGEST, PART, Candidates, disk_choices
from dembound.accuracy.of_disks.causes import (
    Formulas,
    causes_of_choice,
    causes_of_run,
    entry_notes,
    ground_causes,
    quick_causes,
    rest_causes,
)
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.cost import planned_cost
from dembound.accuracy.of_disks.enlarged import extended_disks
from dembound.accuracy.of_disks.exact.references import ExactContinuum, ExactLayeredColumn, ExactPlaneWave
from dembound.accuracy.of_disks.law import elastic_twin
from dembound.accuracy.of_disks.measured import cause_of_packing
from dembound.accuracy.of_disks.search import Search, before_breaks
from dembound.accuracy.proposal import Advice, Proposal, Request, Watch
from dembound.accuracy.reference import Exact
from dembound.accuracy.runner import BUDGET, SHORT, Runner
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.types import LAWS, require_linear
from dembound.disks.contacts.pairs import BREAK_TIME
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.formulas.cause import Causes, Truth
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.rest import causes_of_rest
from dembound.formulas.history import Motions
from dembound.motion.endings import monitored
from dembound.motion.kind import Plan
from dembound.running.planning import plan
from dembound.schemas import with_changes
from dembound.words import percent, with_unit


def _given(companions: Companions, of: Truth, cost: float, watch: Watch) -> Proposal:
    """The proposal of the unchanged case."""
    scene = companions.scene
    ground = ground_causes(companions, scene, companions.time_step, watch)
    causes = causes_of_choice(companions, scene, companions.time_step, 0.0, ground)
    causes += rest_causes(companions, scene) + Causes([], [], entry_notes(scene))
    budget = Budget(companions.recorded(scene), causes, of)
    return Proposal(Choice(OWN + before_breaks(companions), {}, companions.case), cost, budget)


def _best(given: Proposal, case: DiskCase, searches: Sequence[Search], bound: float) -> Proposal:
    """The best choice of several searches, at least the given case; the second runs only if the first finds none."""
    found = [given]
    for search in searches:
        found.append(search.proposal(case, bound))
        if found[-1].holds(bound) or (search.twin is not None and search.twin.stress == 0.0):
            break
    if kept := [each for each in found if each.holds(bound)]:
        return min(kept, key=lambda each: each.cost)
    least = min(found, key=lambda each: each.budget.worst().share.upper)
    if least is given and any(search.was_cut for search in searches):
        return replace(given, choice=replace(given.choice, name=given.choice.name + CUT))
    return least


def _require_linear(case: DiskCase) -> None:
    """Raise CaseError where nothing knows errors: by the law, beside walls and joints, and of means over polygons."""
    require_linear(case.material.law)
    if means := [monitor.name for monitor in case.monitor if monitor.points]:
        raise CaseError([f"monitor.{means[0]}.points: errors are known only at single places"], case.name)
    if case.wall:
        raise CaseError(["wall: errors are known only where no disks touch walls"], case.name)
    for key in ("joint", "group"):
        if getattr(case, key):
            said = f"errors of motion beside {key}s are not predicted; compare runs with smaller disks"
            raise CaseError([f"{key}: {said}"], case.name)


def require_one_ground(case: DiskCase) -> None:
    """Raise CaseError for ground whose layers differ left and right, of which errors are not predicted."""
    if case.is_unlike:
        said = "errors are not predicted where the layers left and right differ; compare with sides farther away"
        raise CaseError([f"ground.meet: {said}"], case.name)


def _require_known(case: DiskCase) -> None:
    """Raise CaseError where errors, or the body itself, depend on unknown properties of other disks and sides."""
    problems = []
    if case.static is not None and case.static.from_ is not None:
        problems.append("static.from: is the body of the given disks and sides; must be left out for advice")
    if not case.driving and case.incident is None:
        reason = "starts waves everywhere, so that their delay by the disks is not known; advice needs a place"
        problems += [
            f"load.{load.name}: {reason}" for load in case.load if load.is_everywhere and load.wave is not None
        ]
    if problems:
        raise CaseError(problems, case.name)


def _is_reached(planned: Plan[DiskScene]) -> bool:
    """Whether the fastest waves reach any monitor within the run."""
    scene, duration = planned.scene, planned.scene.case.run.duration
    front, places = planned.kind.front(scene, planned.time_step), monitored(scene)
    return any(
        float(source.distance(places).min()) <= front.reach(duration - source.start)
        for source in planned.kind.sources(scene)
    )


REALISATIONS = (
    "choices differ in their random packing, and every packing is another realisation of the rock: errors beside a run "
    "with one of them include the difference between realisations, which smaller disks do not remove"
)


class DiskJudge(Judge[DiskCase, DiskScene]):
    """Errors of bonded disks."""

    first_break = BREAK_TIME

    def causes(
        self, case: DiskCase, recorded: Motions, time_step: float, work: float, watch: Watch, longest: float | None
    ) -> Causes:
        """Errors of sides, from companions; of dispersion, steps, continuum and walls, by formulas."""
        self.require_known(case)
        return causes_of_run(case, recorded, time_step, work, max(SHORT, BUDGET * work), watch, longest)

    def require_known(self, case: DiskCase) -> None:
        """Raise CaseError for cases of which errors are not predicted: by their law, their ground, or what is in it."""
        _require_linear(case)
        require_one_ground(case)

    def truth(self, case: DiskCase) -> Truth:
        """The default truth: "disks" where the packing is random or bonds may break, else "rock"."""
        is_grid = case.packing.is_lattice and not LAWS[case.material.law].has_history
        return "rock" if is_grid else "disks"

    def at_start(self, case: DiskCase, recorded: Motions, summary: Mapping[str, Any]) -> Causes:
        """Errors by what the static stage left out of balance."""
        static = summary["static"]
        return Causes([]) if static is None else causes_of_rest(build(case), recorded, static)

    def notes(self, case: DiskCase, summary: Mapping[str, Any]) -> Iterator[str]:
        """A line on the ratio of the motion to the limit of the elastic law; damped ground has no load factor."""
        if not LAWS[case.material.law].is_linear:
            return
        limit = summary.get("load_factor")
        if limit is None:
            found = "; output.load_factor = true finds up to which waves it holds" if _takes_load_factor(case) else ""
            yield f"the elastic law is taken as given{found}"
        elif limit["factor"] is None:
            yield "the elastic law holds under waves of any size"
        else:
            yield f"the elastic law holds up to {limit['factor']:.3g} times these waves, then {limit['limit']}"

    def advise(self, case: DiskCase, asked: Request) -> Advice:
        """The cheapest disks, sides and boxes in a continuum.

        With the truth "disks" the disks do not change; choices do not depend on the scatter between packings. A case
        that keeps the only bound in less time than a search takes is the choice itself.

        Raises CaseError for cases without waves and where no choice keeps the values of `kept`; the errors of building
        and running the companions.
        """
        self.require_known(case)
        _require_known(case)
        of, longest, bounds, watch = asked.of, asked.longest, asked.bounds, asked.watch
        kept = [*asked.kept, "packing.radius"] if of == "disks" else asked.kept
        watch.begins("the packing, and the time step")
        planned: Plan[DiskScene] = plan(case)
        most = max(SHORT, BUDGET * planned.scene.count * planned.steps)
        runner, reflections = Runner(shown=watch.run), Reflections(watch.begins)
        companions = Companions(case, planned.scene, planned.time_step, most, runner, reflections)
        own_cost = planned_cost(planned).seconds
        try:
            search = with_unit(max(LONGEST, PART * max(own_cost, longest or 0.0)), "s", 2)
            require_short(companions, own_cost, longest, watch, f", and searches for at most {search}")
            moved = [own.values["velocity"] for own in companions.recorded(companions.scene).values()]
        except CaseError as error:
            what = f"advise: the same with disks of {companions.diameter:.4g} m, which it has to run, is refused"
            raise CaseError([f"{what}: {problem}" for problem in error.problems], case.name) from error
        if not _is_reached(planned) or not any(map(np.any, moved)):
            raise CaseError(["advise: nothing moves at the monitors"], case.name)
        given = _given(companions, of, own_cost, watch)
        shown = given
        if asked.seeds > 1:
            shown = given.with_causes(cause_of_packing(case, given.budget.motions, asked.seeds, watch.run))
        watch.given(shown)
        if len(bounds) == 1 and given.cost < LONGEST and given.holds(bounds[0]):
            watch.best(bounds[0], given)
            return Advice(shown, {bounds[0]: given}, 1)
        candidates = Candidates(planned, kept, given.cost, runner, None, longest, len(bounds))
        searches = [Search(companions, candidates, of, kept, watch)]
        searches[0].know(given.budget)
        if bounds and (twin := elastic_twin(case, planned, most, kept, runner, reflections)) is not None:
            elastic = twin.planned
            own = Companions(twin.case, elastic.scene, elastic.time_step, most, runner, reflections)
            cost = planned_cost(elastic).seconds
            candidates = Candidates(elastic, kept, cost, runner, twin, longest, len(bounds))
            searches.insert(0, Search(own, candidates, of, kept, watch))
        best = {}
        for number, bound in enumerate(sorted(bounds, reverse=True)):
            watch.part = f"within {percent(bound, 3)}, {number + 1} of {len(bounds)}"
            best[bound] = _best(given, case, searches, bound)
            watch.best(bound, best[bound])
        return Advice(shown, best, sum(search.tried for search in searches))

    def extended(self, case: DiskCase, most: int) -> Extended:
        """The scene with more bricks beyond its sides."""
        require_one_ground(case)
        return extended_disks(case, most)

    def exact(self, case: DiskCase) -> Exact[DiskCase] | None:
        """Plane waves, or one of the problems of `exact`; raises CaseError if the loads match none of them."""
        require_one_ground(case)
        if (plane := ExactPlaneWave.of(case) or ExactLayeredColumn.of(case)) is not None:
            return plane
        return ExactContinuum.of(case) if case.load or case.incident else None

    def chart_choices(self, case: DiskCase) -> Named:
        """Coarser disks, half the step, other sides and a box in the ground."""
        require_one_ground(case)
        return disk_choices(case)

    def hides_sides(self, case: DiskCase) -> bool:
        """Whether the case has holes, whose walls consist of disks."""
        return bool(case.holes)

    def has_input_continuum(self, case: DiskCase) -> bool:
        """Whether waves enter through a continuum round disks that fill the scene."""
        return case.ground.size is None and any(case.side(side).waves for side in case.outside_sides)

    def cautions(self, cases: Sequence[DiskCase]) -> tuple[str, ...]:
        """A warning that packings differ at random, if bricks differ and some are random."""
        packings = [case.packing for case in cases]
        bricks = {repr(packing.with_copies(1, 1).model_copy(update={"origin": (0.0, 0.0)})) for packing in packings}
        are_alike = len(bricks) < 2 or all(packing.is_lattice for packing in packings)
        return () if are_alike else (REALISATIONS,)

    def of_reference(self, case: DiskCase, motions: Motions, time_step: float) -> Causes:
        """All causes known by formula: dispersion, steps, walls, disks near loads, sides that waves enter through."""
        require_one_ground(case)
        plane = {
            name: replace(own, values={q: v[:, :2] for q, v in own.values.items()}) for name, own in motions.items()
        }
        return Causes(Formulas(build(case), time_step).causes(plane), motions=plane)

    def quick(self, scene: DiskScene) -> Causes:
        """The continuum and walls by formula."""
        self.require_known(scene.case)
        return quick_causes(scene)


def _takes_load_factor(case: DiskCase) -> bool:
    """Whether a case may ask for its load factor."""
    try:
        with_changes(case, {"output.load_factor": True})
    except CaseError:
        return False
    return True

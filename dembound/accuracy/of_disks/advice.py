"""The errors of a case of disks, and the cheapest choices for bounds, under its own law or an elastic one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.cause import Causes, Truth
from dembound.accuracy.choice import OWN, Choice
from dembound.accuracy.of_disks.causes import causes_of_choice, entry_notes, of_ground, of_rest
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.cost import planned_cost
from dembound.accuracy.of_disks.law import elastic_twin
from dembound.accuracy.of_disks.search import CUT, LONGEST, Search, before_breaks
from dembound.accuracy.proposal import Advice, Proposal, Receiver
from dembound.accuracy.runner import BUDGET, SHORT, Runner
from dembound.accuracy.watch import begins, current
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.motion.kind import Plan
from dembound.motion.silence import monitored
from dembound.running import plan
from dembound.words import percent


def advice_for_disks(
    case: DiskCase,
    bounds: Sequence[float],
    of: Truth,
    kept: Sequence[str],
    longest: float | None,
    receiver: Receiver,
) -> Advice:
    """The errors of a case, and for every bound the cheapest choice that keeps it, or else the most accurate choice.

    of : truth to which errors are relative; with "disks" the disks do not change. kept : keys that do not change.
    longest : CPU seconds that the steps of a choice may take; None: the default. receiver : of what is known before all
    is. A case that keeps the only bound in
    less time than a search takes is the choice itself.

    Raises CaseError for cases without waves and where no choice keeps the values of `kept`; the errors of building and
    running the companions.
    """
    _require_known(case)
    kept = [*kept, "packing.radius"] if of == "disks" else kept
    begins("the packing, and the time step")
    planned: Plan[DiskScene] = plan(case)
    most = max(SHORT, BUDGET * planned.scene.count * planned.steps)
    companions = Companions(case, planned.scene, planned.time_step, most, Runner())
    try:
        moved = [own.values["velocity"] for own in companions.recorded(companions.scene).values()]
    except CaseError as error:
        what = f"advise: the same with disks of {companions.diameter:.4g} m, which it has to run, is refused"
        raise CaseError([f"{what}: {problem}" for problem in error.problems], case.name) from error
    if not _is_reached(planned) or not any(map(np.any, moved)):
        raise CaseError(["advise: nothing moves at the monitors"], case.name)
    given = _given(companions, of, planned_cost(planned).seconds)
    receiver.given(given)
    if len(bounds) == 1 and given.cost < LONGEST and given.holds(bounds[0]):
        receiver.best(bounds[0], given)
        return Advice(given, {bounds[0]: given}, 1)
    searches = [Search(companions, planned, of, kept, given.cost, longest=longest)]
    searches[0].know(given.budget)
    if bounds and (twin := elastic_twin(case, planned, most, kept, companions.runner)) is not None:
        own = Companions(twin.case, twin.planned.scene, twin.planned.time_step, most, companions.runner)
        cost = planned_cost(twin.planned).seconds
        searches.insert(0, Search(own, twin.planned, of, kept, cost, twin, longest))
    best = {}
    for number, bound in enumerate(sorted(bounds, reverse=True)):
        current().part = f"within {percent(bound, 3)}, {number + 1} of {len(bounds)}"
        best[bound] = _best(given, case, searches, bound)
        receiver.best(bound, best[bound])
    return Advice(given, best, sum(search.tried for search in searches))


def _given(companions: Companions, of: Truth, cost: float) -> Proposal:
    """The proposal of the unchanged case."""
    scene = companions.scene
    ground = of_ground(companions, scene, companions.time_step, told=True)
    causes = causes_of_choice(companions, scene, companions.time_step, 0.0, ground)
    causes += of_rest(companions, scene) + Causes([], [], entry_notes(scene))
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

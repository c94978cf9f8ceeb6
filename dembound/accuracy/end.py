"""Ending a run before its duration, once its monitors are silent and no later motion counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.accuracy.choice import Choice
from dembound.accuracy.proposal import Proposal
from dembound.casefile import Case
from dembound.errors import DemboundError
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import Motions
from dembound.kinds import with_changes
from dembound.motion.endings import last_loud, silent_rule
from dembound.running import plan

END = "end"
"""Cause of errors: motion after the end."""

LEVEL_SHARE = 0.1
"""Level below which monitors are silent, over the error asked for, if that is above the default level."""

LEAST_SAVED = 0.1
"""Part of the duration that an earlier end must save."""

KEYS = ("run", "run.duration", "run.until", "run.silent_level", "run.silent_for")
"""Keys that, where one is kept, leave the end as it is."""


@dataclass(frozen=True)
class EarlierEnd:
    """An end before the duration.

    case : with this end. share : of the duration. lost : the error by the motion that is not recorded.
    """

    case: Case
    share: float
    lost: Cause


def ended_earlier(best: Proposal, given: Case, bound: float, motion: Motions, kept: Sequence[str]) -> Proposal:
    """A proposal with the earliest end with which it still keeps its bound; unchanged if no earlier end does.

    given : the case that the proposal is a choice for. motion : expected records of its monitors. kept : keys that do
    not change.
    """
    for end in earlier_ends(best.case, motion, bound, kept) if best.holds(bound) else []:
        words = f"{best.choice.name}, until the monitors are silent after about {end.share * given.run.duration:.3g} s"
        budget = replace(best.budget, causes=best.budget.causes + Causes([end.lost]))
        found = Proposal(Choice.of(given, end.case, words), end.share * best.cost, budget)
        if found.holds(bound):
            return found
    return best


def earlier_ends(case: Case, motion: Motions, bound: float, kept: Sequence[str]) -> list[EarlierEnd]:
    """Ends of a run with `until = "silent"`, the earliest first, without ends that save little.

    motion : expected records of its monitors, at the same times. bound : error bound. kept : keys that do not change.
    """
    if case.run.until != "duration" or any(key in KEYS for key in kept):
        return []
    default = float(type(case.run).model_fields["silent_level"].default)
    levels: dict[float, dict[str, object]] = {default: {}}
    if (level := float(f"{LEVEL_SHARE * bound:.3g}")) > default:
        levels[level] = {"run.silent_level": level}
    found = [_ended(case, motion, {"run.until": "silent", **change}) for change in levels.values()]
    return sorted((each for each in found if each is not None), key=lambda each: each.share)


def _ended(case: Case, motion: Motions, changes: Mapping[str, object]) -> EarlierEnd | None:
    """The end by one level of silence; None if it saves little, or the case cannot run."""
    try:
        changed = with_changes(case, changes)
        planned = plan(changed)
    except DemboundError:
        return None
    rule = silent_rule(planned.scene, planned.kind.sources(planned.scene))
    time = next(iter(motion.values())).time
    speeds = np.column_stack([np.abs(each.values["velocity"]).max(axis=1) for each in motion.values()])
    loud = last_loud(speeds, rule.level, np.zeros(speeds.shape[1]))
    end = max(time[loud] if loud >= 0 else 0.0, rule.earliest) + rule.hold
    if end > (1.0 - LEAST_SAVED) * case.run.duration:
        return None
    return EarlierEnd(changed, float(end / case.run.duration), _lost(motion, float(end)))


def _lost(motion: Motions, end: float) -> Cause:
    """The error by unrecorded motion after the end: minus that motion, displacement relative to the last sample."""
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in motion.items():
        late = own.time > end
        last = np.argmax(late) - 1 if late.any() else -1
        errors[name] = {
            quantity: np.where(late[:, None], (values[last] if quantity == "displacement" else 0.0) - values, 0.0)
            for quantity, values in own.values.items()
        }
    return Cause(END, "by the motion after the monitors are silent", errors, "measured")

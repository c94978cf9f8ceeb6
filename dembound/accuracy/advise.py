"""The cheapest choice for a case of any kind."""

from __future__ import annotations

from collections.abc import Sequence

from dembound.accuracy.best import Best
from dembound.accuracy.differences import value_at
from dembound.accuracy.judges import judge_of
from dembound.casefile import Case
from dembound.errors import CaseError


def choose(case: Case, bound: float, kept: Sequence[str] = ()) -> Best:
    """The cheapest choice whose errors are within a bound at all monitors; without one that with the smallest error.

    A bound is RMS over RMS, such as 0.01, of velocity and displacement, of bars of stress, too. kept : dotted keys
    whose values remain as given, such as ``packing.radius`` or ``boundary``. Monitors that hardly move do not count.

    Raises CaseError for cases without monitors, without motion at them, or whose errors are not known, for a bound that
    is none and for unknown keys; the errors of building a scene and of running companions.
    """
    if not 0.0 < bound < 1.0:
        raise CaseError([f"--error: is {bound:g}, must be above 0 and below 1, such as 1% or 0.01"])
    if not case.monitor:
        raise CaseError(["--error: needs a monitor, at which the error is bounded"], case.name)
    for key in kept:
        value_at(case, key)
    return judge_of(case).best(case, bound, kept)

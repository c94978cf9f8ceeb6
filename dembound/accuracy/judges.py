"""The judges of all kinds of bodies; this file alone names the kinds."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from dembound.accuracy.judge import Judge
from dembound.casefile import Case
from dembound.kinds import kind_of


@cache
def _of_bars() -> Judge[Any, Any]:
    from dembound.accuracy.of_bars.judge import BarJudge

    return BarJudge()


@cache
def _of_disks() -> Judge[Any, Any]:
    from dembound.accuracy.of_disks.judge import DiskJudge

    return DiskJudge()


JUDGES: Mapping[str, Callable[[], Judge[Any, Any]]] = {"bar": _of_bars, "disks": _of_disks}
"""By the name of the kind; only the one that is needed is imported."""


def judge_of(case: Case) -> Judge[Any, Any]:
    """The judge of the kind of body that a case describes."""
    return JUDGES[kind_of(case).name]()

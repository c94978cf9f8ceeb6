"""The judges of errors of all kinds of bodies, and enlarged scenes; this file alone names the kinds."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from dembound.accuracy.judge import Judge
from dembound.accuracy.moved_sides import Extended
from dembound.casefile.model import Case
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


MOST = 8_000_000
"""Particles of the largest scene that is made unless another limit is given; its run takes some 2 GB."""


def extended(case: Case, most: int = MOST) -> Extended:
    """The scene of a case enlarged so that nothing returns from artificial sides to its monitors within run.duration.

    Without monitors nothing returns to any place of the scene. The time step remains that of the case. Bars are
    extended beyond ends that are neither loaded nor driven.

    most : largest number of particles or nodes.

    Raises CaseError where no artificial side can move, where a hole reaches beyond a side that has to, and where more
    than `most` particles are needed; also the errors of building the scene.
    """
    return judge_of(case).extended(case, most)

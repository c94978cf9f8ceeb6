"""The judges of errors of all kinds of bodies, and enlarged scenes."""

from functools import cache
from pkgutil import resolve_name
from typing import Any

from dembound.accuracy.judge import Judge
from dembound.accuracy.moved_sides import Extended
from dembound.casefile.model import Case
from dembound.schemas import body_of


@cache
def _made(place: str) -> Judge[Any, Any]:
    """The judge at a place such as "package.module:Class"."""
    return resolve_name(place)()


def judge_of(case: Case) -> Judge[Any, Any]:
    """The judge of the kind of body that a case describes; only the one that is needed is imported."""
    return _made(body_of(case).judge)


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

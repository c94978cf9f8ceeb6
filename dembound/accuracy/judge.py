"""How every kind of body gives the errors of its cases, advised choices, and enlarged scenes; the judge of a case."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pkgutil import resolve_name
from typing import Any, ClassVar, Generic, TypeVar

from dembound.accuracy.choice import Choice, Named
from dembound.accuracy.proposal import Advice, Request, Watch
from dembound.accuracy.reference import Exact, FinerRun
from dembound.accuracy.runner import Run
from dembound.boundaries import SIDES
from dembound.casefile import Case, tables
from dembound.errors import CaseError
from dembound.formulas.cause import Causes, Truth
from dembound.formulas.history import Motions
from dembound.motion.scene import Scene
from dembound.results.histories import Quantity
from dembound.schemas import body_of
from dembound.table import Box

LESS = 0.95
"""Largest `run.safety` with which the step of the case is also stable in the larger scene.

There the disks of a moved side have more neighbours, and the limit of the step may be some per cent smaller. With a
larger safety the step remains "auto".
"""

R = TypeVar("R", bound=tables.Run)


@dataclass(frozen=True)
class Extended:
    """An enlarged case.

    case : the enlarged case, named as the case with "_extended"; the case itself if no side has to move.
    sentence : its size, the number of its particles, and from which sides nothing returns.
    inside : rectangle of the given case's scene in the enlarged one, m; a bar begins at zero whatever its length.
    """

    case: Case
    sentence: str
    inside: Box


def movable(case: Case, loaded: Sequence[str] = ()) -> list[str]:
    """The artificial sides that can move; loaded : sides on which loads act.

    Raises CaseError if there are artificial ones, and none can move.
    """
    artificial = [side for side in SIDES if case.side(side).is_artificial]
    moving = [side for side in artificial if case.side(side).may_move and side not in loaded]
    if artificial and not moving:
        reason = "lets motion in, so it cannot move away without changing that; no other side is artificial"
        raise CaseError([f"boundary.{artificial[0]}: {reason}, and the scene cannot be extended"], case.name)
    return moving


def must_not_exceed(count: int, most: int, size: str, case: Case) -> None:
    """Raise CaseError for a scene that is too large."""
    if count > most:
        scene = f"a scene of {size} with {count:,} particles, more than {most:,}"
        what = f"run.duration: is {case.run.duration:g} s, for which nothing returns only in {scene}"
        raise CaseError([f"{what}; take a shorter run, or coarser particles"], case.name)


def sentence_of(case: Case, what: str, moving: list[str]) -> str:
    """The size of the enlarged scene, and the sides from which nothing returns, in words."""
    artificial = [side for side in SIDES if case.side(side).is_artificial]
    if not artificial:
        return f"reference: {what}, none of whose sides is artificial"
    staying = [side for side in artificial if side not in moving]
    until = f"nothing returns before {case.run.duration:g} s"
    if not staying:
        return f"reference: {what}, from which {until}"
    stay, reflect = ("stay", "reflect") if len(staying) > 1 else ("stays", "reflects")
    stays = f"{what}, from whose {' and '.join(moving)} {until}; {' and '.join(staying)} {stay}, as waves enter there"
    absorbers = dict.fromkeys(case.side(side).absorber for side in staying)
    if all(absorbers):
        return f"reference: {stays}, before {' and '.join(absorbers)}, which returns next to nothing"
    return f"reference: {stays}, and {reflect} as in the case"


def same_step(run: R, step: float) -> R:
    """The ``[run]`` table with the time step (s) of the case."""
    if run.time_step != "auto" or run.safety > LESS or getattr(run, "courant", None) is not None:
        return run
    return run.model_copy(update={"time_step": step})


C = TypeVar("C", bound=Case)
S = TypeVar("S", bound=Scene)


class Judge(ABC, Generic[C, S]):
    """Errors of one kind of body: their causes, references for comparison, and the choices that a case leaves open.

    Attributes
    ----------
    from_left_end : findings of its runs that are places, m from the left end, which extended scenes have elsewhere.
    first_break : its finding that is the time (s) of the first break.
    quantities : quantities that its monitors record and charts compare.
    """

    from_left_end: ClassVar[Sequence[str]] = ()
    first_break: ClassVar[str]
    quantities: ClassVar[Sequence[Quantity]] = ("velocity", "displacement")

    @abstractmethod
    def causes(
        self, case: C, recorded: Motions, time_step: float, work: float, watch: Watch, longest: float | None
    ) -> Causes:
        """The causes of the error of a run.

        case : to the end of the run. recorded : by monitor, up to the time until which errors are estimated. time_step
        (s), work (in the unit of its kind) : of the run. watch : told of what is done. longest : CPU seconds that
        companions may take, if that is more than by default.
        """

    def require_known(self, case: C) -> None:
        """Raise CaseError for a case of which errors are not predicted; by default there are none."""

    def truth(self, case: C) -> Truth:
        """The truth, "disks" or "rock", to which errors of a case are relative by default."""
        return "rock"

    def at_start(self, case: C, recorded: Motions, summary: Mapping[str, Any]) -> Causes:
        """Causes of the error of a run by the state in which it began, from the summary of its results; none."""
        return Causes([])

    def notes(self, case: C, summary: Mapping[str, Any]) -> Iterator[str]:
        """Lines on the validity of a run's estimate, from the summary of its results; by default none."""
        yield from ()

    @abstractmethod
    def advise(self, case: C, asked: Request) -> Advice:
        """The errors of a case, and the cheapest choices for several bounds.

        Raises CaseError for cases whose errors are not known, that do not move at their monitors, and where no choice
        keeps the values of `kept`; for several seeds of a case without any; the errors of building a scene and of runs.
        """

    @abstractmethod
    def extended(self, case: C, most: int) -> Extended:
        """The scene of a case enlarged to at most `most` nodes, see `extended.extended`."""

    @abstractmethod
    def exact(self, case: C) -> Exact[C] | None:
        """The exact solution of a case, or None; raises CaseError if its loads belong to no known problem."""

    def finer(self, case: C, choices: Sequence[Choice[C]], outcomes: Sequence[Run]) -> FinerRun | None:
        """A run with a finer grid than those of all choices, whose runs are the outcomes; by default None."""
        return None

    @abstractmethod
    def chart_choices(self, case: C) -> Named:
        """Choices for the chart of a case where neither the command nor the case gives any."""

    def hides_sides(self, case: C) -> bool:
        """Whether, beside an exact solution, other errors of the body hide those of its sides; by default False."""
        return False

    def has_input_continuum(self, case: C) -> bool:
        """Whether waves enter a scene that can be extended through a continuum, by default not."""
        return False

    def cautions(self, cases: Sequence[C]) -> tuple[str, ...]:
        """Lines on what differences between runs of some cases contain besides errors."""
        return ()

    def of_reference(self, case: C, motions: Motions, time_step: float) -> Causes:
        """Causes of the error of a run used as reference, but for sides without waves; by default none.

        motions : at its monitors; time_step : s.
        """
        return Causes([])

    def quick(self, scene: S) -> Causes:
        """Causes of errors of a scene; those that need its motion are unknown. By default none."""
        return Causes([])


def no_seed(case: Case) -> CaseError:
    """The error for a request of other seeds for a case without a random packing."""
    return CaseError(["--seeds: the case has no random packing, so that nothing depends on a seed"], case.name)


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

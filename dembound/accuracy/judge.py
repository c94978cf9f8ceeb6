"""The interface by which every kind of body gives the errors of its cases, and the choices advised for one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, Generic, TypeVar

from dembound.accuracy.choice import Choice, Named
from dembound.accuracy.moved_sides import Extended
from dembound.accuracy.proposal import Advice
from dembound.accuracy.reference import Exact, FinerRun
from dembound.accuracy.runner import Run
from dembound.accuracy.watch import Watch
from dembound.casefile.model import Case
from dembound.errors import CaseError
from dembound.formulas.cause import Causes, Truth
from dembound.formulas.history import Motions
from dembound.motion.scene import Scene
from dembound.results.histories import Quantity

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
    def causes(self, case: C, recorded: Motions, time_step: float, work: float, most: float, watch: Watch) -> Causes:
        """The causes of the error of a run.

        case : to the end of the run. recorded : by monitor, up to the time until which errors are estimated. time_step
        (s), work (in the unit of its kind) : of the run. most : work that may be spent. watch : told of what is done.
        """

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
    def advise(
        self,
        case: C,
        bounds: Sequence[float],
        of: Truth,
        kept: Sequence[str],
        longest: float | None,
        seeds: int,
        watch: Watch,
    ) -> Advice:
        """The errors of a case, and the cheapest choices for several bounds.

        kept : keys that do not change. longest : CPU seconds that the steps of a choice may take; None: the default.
        seeds : random packings that are run to find the scatter of the case's motion; 1: none. watch : told of what is
        done, and of what is known before all is.

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
    reason = "the case has no random packing, so that nothing depends on a seed"
    return CaseError([f"--seeds: {reason}"], case.name)

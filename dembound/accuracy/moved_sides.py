"""Enlarged scenes of all kinds: sides that move, their size in words, and their time step."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

from dembound.boundaries import SIDES
from dembound.casefile import Case
from dembound.casefile.tables import Run
from dembound.errors import CaseError
from dembound.table import Box

LESS = 0.95
"""Largest `run.safety` with which the step of the case is also stable in the larger scene.

There the disks of a moved side have more neighbours, and the limit of the step may be some per cent smaller. With a
larger safety the step remains "auto".
"""

R = TypeVar("R", bound=Run)


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
        raise CaseError(
            [
                f"boundary.{side}: lets motion in, so it cannot move away without changing that; no other side is "
                "artificial, and the scene cannot be extended"
                for side in artificial[:1]
            ],
            case.name,
        )
    return moving


def must_not_exceed(count: int, most: int, size: str, case: Case) -> None:
    """Raise CaseError for a scene that is too large."""
    if count > most:
        raise CaseError(
            [
                f"run.duration: is {case.run.duration:g} s, for which nothing returns only in a scene of {size} with "
                f"{count:,} particles, more than {most:,}; take a shorter run, or coarser particles"
            ],
            case.name,
        )


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

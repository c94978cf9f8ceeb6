"""The options --error and --keep of check and run: the cheapest choice that is accurate enough."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.console import out
from dembound.errors import CaseError, NotAccurateError
from dembound.words import percent

if TYPE_CHECKING:
    from dembound.accuracy.best import Best
    from dembound.casefile import Case

Error = Annotated[
    str | None,
    typer.Option(
        "--error",
        metavar="ERROR",
        help="Largest error of velocity and displacement at all monitors, RMS over RMS, such as 1% or 0.01. "
        "Sides, their distance, the box of disks, the diameter of a lattice, elements beyond it, half of a symmetric "
        "scene, the law where nothing opens, of a bar spacing, time step and absorbing ends, and an end once monitors "
        "are silent are chosen as cheaply as this allows; waves, stiffness, loads, holes and monitors remain.",
    ),
]
Keep = Annotated[
    list[str] | None,
    typer.Option(
        "--keep",
        metavar="KEY",
        help="With --error: a key or table that is not changed, e.g. packing.radius or boundary. May be repeated; keys "
        "given by --set are not changed either.",
    ),
]


def bound_of(error: str | None, keep: Sequence[str] | None) -> float | None:
    """The bound that ``--error`` gives, None without it.

    Raises CaseError for a text that is no share between 0 and 1, and for ``--keep`` without ``--error``.
    """
    if error is None:
        if keep:
            raise CaseError(["--keep: needs --error, without which nothing is changed"])
        return None
    text = error.strip()
    try:
        bound = 0.01 * float(text[:-1]) if text.endswith("%") else float(text)
    except ValueError:
        bound = 0.0
    if not 0.0 < bound < 1.0:
        raise CaseError([f"--error: is {error}, must be above 0 and below 1, such as 1% or 0.01"])
    return bound


def name_within(name: str, bound: float) -> str:
    """The name of the results of a case that is run within an error bound: ``bar_1pct``, ``bar_0_3pct``."""
    number = f"{Decimal(f'{100.0 * bound:.6g}'):f}"
    return f"{name}_{number.replace('.', '_')}pct"


def chosen(case: Case, bound: float, keep: Sequence[str] | None, changes: Sequence[str] | None) -> Case:
    """The case with the cheapest choice that keeps an error bound, which is printed.

    keep : as of the option; changes : those of ``--set``, whose keys are kept, too.

    Raises NotAccurateError if no choice keeps the bound, with the best one; and the errors of `choose`.
    """
    from dembound.accuracy.advise import choose
    from dembound.results.estimates import in_words

    kept = [*(keep or ()), *(text.partition("=")[0].strip() for text in changes or ())]
    best = choose(case, bound, kept)
    lines = _lines(best)
    if not best.holds:
        found = f"the best of {best.tried} choices has {in_words(best.error)}"
        said = f"--error: no choice keeps {percent(bound, 3)}; {found}: {lines[0]}"
        raise NotAccurateError("\n".join([said, *lines[1:]]))
    for line in lines:
        out.print(f"{case.name}: {line}", markup=False)
    return best.case


def _lines(best: Best) -> list[str]:
    """The choice in words, with its error and cost, and the keys that it changes."""
    from dembound.results.estimates import in_words, split_in_words

    return [
        f"{best.words}; expected error {in_words(best.error)} ({split_in_words(best.by)}), "
        f"steps of about {best.cost:.2g} s instead of {best.own_cost:.2g} s",
        *(best.choice.toml or ["the case as it is"]),
    ]

"""What the command stability prints and writes of the strength of ground under its weight."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from dembound.cli.console import print_lines, print_rows, print_written
from dembound.cli.progress import progress_of
from dembound.errors import RunError
from dembound.words import with_unit

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase
    from dembound.studies.strength.study import Search, Strength


def measure_strength(case: DiskCase, tolerance: float, output: Path) -> None:
    """Measure, print and write (CSV) the factor of safety and the yield accelerations of a case.

    Raises CaseError as `study.measure`, RunError if the body does not stand at full strength.
    """
    from dembound.results.text_files import write_csv
    from dembound.studies.strength.study import measure

    with progress_of(case.name) as shown:
        found = measure(case, tolerance, lambda what: shown.begin(f"{case.name}: {what}"), shown.settling)
    print_rows(f"{case.name}: {found.words[0]}", list(_rows(found)))
    print_lines("", *map(_in_words, found.searches), *(f"  {line}" for line in found.words[1:]))
    write_csv(output, found.rows)
    print_written(output)
    if not found.holds:
        raise RunError(f"{case.name}: does not stand under its weight")


def _rows(found: Strength) -> Iterator[Sequence[str]]:
    """A head, and a row for each state that was tried."""
    yield "", "tried", "stands", "ended by", "moved", "disks", "broken", "steps"
    for search in found.searches:
        for each in search.tried:
            moved = "–" if each.moved != each.moved else with_unit(each.moved, "m")
            counts = [f"{number:,}" for number in (each.left, each.broken, each.steps)]
            stands = "yes" if each.stands else "no"
            yield search.name, f"{each.value:.4g}{_unit(search)}", stands, each.ended, moved, *counts


def _in_words(search: Search) -> str:
    """The number that was searched, and its bracket."""
    unit, least, most = _unit(search), search.stands, search.fails
    if least == 0.0:
        return f"{search.name}: less than {most:.3g}{unit}, the least that was tried"
    if most == float("inf"):
        return f"{search.name}: more than {least:.3g}{unit}, the most that was tried"
    return f"{search.name}: {search.value:.3g}{unit} ({least:.4g} stands, {most:.4g} fails)"


def _unit(search: Search) -> str:
    return "" if search.unit == "1" else f" {search.unit}"

"""Strengths as targets of the command material: bonds with which samples have the strengths asked for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, cast

import typer

from dembound.cli.app import text_for
from dembound.cli.console import err, out
from dembound.cli.sweep import FAILED, shown
from dembound.errors import CaseError
from dembound.interrupts import exit_code_of
from dembound.words import percent

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase
    from dembound.cli.loading_options import LoadingOptions
    from dembound.results.loading_curve import TestName
    from dembound.studies.laboratory.sample import Sample

FOUND = "# found by dembound material:"
"""Begin of the comments above the strengths that are written."""


def match_strengths(
    path: Path,
    case: DiskCase,
    targets: Mapping[str, float],
    settings: list[str] | None,
    seeds: int,
    output: Path,
    loading: LoadingOptions,
) -> None:
    """Find pb_ten and pb_coh with which samples of a case have strengths (Pa) by test, and write the case with them.

    path : of the case, whose comments are kept. settings : changes of its keys, as of --set.

    Raises CaseError for a ratio that parallel bonds do not reach, and if the file to write exists.
    """
    from dembound.casefile.edit import commented, edited
    from dembound.files import write_text
    from dembound.studies.laboratory.strengths import (
        CLOSE,
        Search,
        excess_in_words,
        in_words,
        keys_of,
        measure_in,
        spread_of,
        strength_in_words,
        with_bonds,
    )

    wanted = cast("dict[TestName, float]", dict(targets))
    target = Path(f"{case.name}_strengths.toml")
    if target.exists():
        raise CaseError([f"{target}: exists already; rename or remove it"])

    def make(changed: DiskCase, test: TestName) -> Sample:
        sample = loading.sample(changed, test)
        err.print(f"{case.name}: {test}, {sample.in_words}")
        return sample

    material, options = case.material, loading.options()
    cohesion = 1.0 if material.pb_ten is None or material.pb_coh is None else material.pb_coh / material.pb_ten
    search, done = Search(wanted, cohesion, spread_of(material.pb_scatter)), []
    try:
        with shown(case.name, "samples") as report:
            measure = measure_in(make, case, seeds, options, output / f"{case.name}_strengths", report)
            for trial in search.trials(measure):
                done.append(trial)
                for line in in_words(trial, wanted):
                    out.print(f"{case.name}: {line}")
    except KeyboardInterrupt as stop:
        err.print(f"{case.name}: stopped; the same command continues what is left")
        raise typer.Exit(exit_code_of(stop)) from None
    best = search.best(done)
    keys = keys_of(case, best.pb_ten, best.pb_coh)
    tested = with_bonds(case, best.pb_ten, best.pb_coh)
    said = [f"{FOUND} {strength_in_words(test, best)}; {loading.sample(tested, test).in_words}" for test in wanted]
    text = edited(text_for(target, path, case, settings), keys)
    write_text(target, commented(text, "material.pb_ten", said, FOUND))
    out.print(f"wrote {target}")
    if best.deviation(wanted) > CLOSE:
        missed = ", ".join(f"{test} is {excess_in_words(test, best, wanted)}" for test in wanted)
        err.print(f"{case.name}: no trial of {len(done)} is within {percent(CLOSE)}; written is the best one: {missed}")
        raise typer.Exit(FAILED)

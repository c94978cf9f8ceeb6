"""Strengths as targets of the command material: bonds with which samples have the strengths asked for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, cast

import typer

from dembound.cli.app import settings_of
from dembound.cli.console import err, out
from dembound.cli.sweep import shown
from dembound.errors import CaseError
from dembound.interrupts import exit_code_of

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase
    from dembound.results.loading_curve import TestName
    from dembound.studies.laboratory.sample import Sample


def match_strengths(
    path: Path, case: DiskCase, targets: Mapping[str, float], settings: list[str] | None, seeds: int, output: Path
) -> None:
    """Find pb_ten and pb_coh with which samples of a case have strengths (Pa) by test, and write the case with them.

    path : of the case, whose comments are kept. settings : changes of its keys, as of --set.

    Raises CaseError for a ratio that parallel bonds do not reach, and if the file to write exists.
    """
    from dembound.casefile.edit import edited
    from dembound.results.replacing import replacing
    from dembound.studies.laboratory.sample import LAW, sample_of
    from dembound.studies.laboratory.strengths import (
        MOST_RATIO,
        MOST_SCATTERED,
        changes_of,
        in_words,
        measure_in,
        trials,
    )
    from dembound.studies.sweep.study import Options

    wanted = cast("dict[TestName, float]", dict(targets))
    target = Path(f"{case.name}_strengths.toml")
    if target.exists():
        raise CaseError([f"{target}: exists already; rename or remove it"])

    def make(changed: DiskCase, test: TestName) -> Sample:
        return sample_of(changed, test)

    material = case.material
    ratio = 1.0 if material.pb_ten is None or material.pb_coh is None else material.pb_coh / material.pb_ten
    most = MOST_SCATTERED if getattr(material, "pb_scatter", None) else MOST_RATIO
    try:
        with shown(case.name) as report:
            measure = measure_in(make, case, seeds, Options(), output / f"{case.name}_strengths", report)
            for trial in trials(wanted, ratio, measure, most):
                for line in in_words(trial, wanted):
                    out.print(f"{case.name}: {line}")
    except KeyboardInterrupt as stop:
        err.print(f"{case.name}: stopped; the same command continues what is left")
        raise typer.Exit(exit_code_of(stop)) from None
    changes = changes_of(trial, wanted)
    for key, value in changes.items():
        out.print(f"{case.name}: {key} = {value:g}")
    text = path.read_bytes().decode("utf-8-sig")
    law = {} if material.law == "linearpbond" else {"material.law": LAW}
    with replacing(target) as part:
        part.write_bytes(edited(text, settings_of(settings) | law | changes).encode())
    out.print(f"wrote {target}")

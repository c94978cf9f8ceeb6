"""The command material."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from dembound.cli.app import MORE, Output, Settings, app, few, load_disks
from dembound.cli.calibration import OneCase
from dembound.cli.console import out, print_rows
from dembound.cli.loading_options import LoadingOptions
from dembound.cli.option_tables import with_tables
from dembound.errors import CaseError

SEEDS = 8
"""Samples of each test, by default."""


@app.command("material", rich_help_panel=MORE)
@with_tables
def material(
    case: OneCase,
    *,
    ucs: Annotated[
        float | None, typer.Option(min=0.0, help="Uniaxial compressive strength (Pa) to give samples of the material.")
    ] = None,
    tension: Annotated[
        float | None, typer.Option(min=0.0, help="Tensile strength (Pa) to give them, by direct tension.")
    ] = None,
    seeds: Annotated[
        int, typer.Option(min=1, callback=few, help="Samples of each test, for --ucs and --tension.")
    ] = SEEDS,
    output: Output = Path("results"),
    changes: Settings = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, in SI units, for scripts.")] = False,
    loading: LoadingOptions,
) -> None:
    """Print what contacts and bonds make of the body, without a run.

    Elastic moduli, wave speeds by direction, and the stress of the first crack, by static solves of a brick.

    With --ucs or --tension samples are tested (`dembound test`), and a case is written that has these strengths.
    """
    if targets := {name: value for name, value in (("ucs", ucs), ("tension", tension)) if value}:
        from dembound.cli.strengths import match_strengths

        if as_json:
            raise CaseError(["--json: is for the tables without a run, not allowed with --ucs or --tension"])
        match_strengths(case, load_disks(case, changes), targets, changes, seeds, output, loading)
        return
    if given := [*(["--seeds"] if seeds != SEEDS else []), *loading.given]:
        raise CaseError([f"{', '.join(given)}: for tests of samples, give --ucs or --tension"])
    from dembound.disks.reports.micro_macro import describe_materials, material_rows, packing_line
    from dembound.disks.scene import build

    found = describe_materials(build(load_disks(case, changes)))
    if as_json:
        for line in json.dumps(found, indent=2, allow_nan=False).splitlines():
            out.print(line, soft_wrap=True)
        return
    for each in found:
        if each["layer"]:
            out.print(f"layer {each['layer']}")
        out.print(packing_line(each))
        for title, rows in material_rows(each):
            out.print()
            print_rows(title, rows)
        out.print()

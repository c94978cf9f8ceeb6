"""The command material."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from dembound.cli.app import MORE, Settings, app, load_disks
from dembound.cli.calibration import OneCase
from dembound.cli.console import out, print_rows


@app.command("material", rich_help_panel=MORE)
def material(
    case: OneCase,
    changes: Settings = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, in SI units, for scripts.")] = False,
) -> None:
    """Print what contacts and bonds make of the body, without a run.

    Elastic moduli, wave speeds by direction, and the stress of the first crack, by static solves of a brick.
    """
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

"""The commands material and packing."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from dembound.cli.app import MORE, PICTURE, Cases, Output, PictureTitle, Settings, Side, app, few, load_disks, text_for
from dembound.cli.calibration import OneCase
from dembound.cli.console import ending_with, err, out, print_lines, print_rows
from dembound.cli.laboratory import LoadingOptions
from dembound.cli.options import leave, with_tables
from dembound.cli.sweep import FAILED, shown
from dembound.errors import CaseError
from dembound.words import percent

if TYPE_CHECKING:
    from dembound.boundaries.edge import Edge
    from dembound.casefile.disks.model import DiskCase
    from dembound.disks.scene import DiskScene
    from dembound.results.recording import TestName
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
    said = f"{case.name}: stopped; the same command continues what is left"
    with ending_with(said), shown(case.name, "samples") as report:
        measure = measure_in(make, case, seeds, options, output / f"{case.name}_strengths", report)
        for trial in search.trials(measure):
            done.append(trial)
            for line in in_words(trial, wanted):
                out.print(f"{case.name}: {line}")
    best = search.best(done)
    keys = keys_of(case, best.pb_ten, best.pb_coh)
    tested = with_bonds(case, best.pb_ten, best.pb_coh)
    comments = [f"{FOUND} {strength_in_words(test, best)}; {loading.sample(tested, test).in_words}" for test in wanted]
    text = edited(text_for(target, path, case, settings), keys)
    write_text(target, commented(text, "material.pb_ten", comments, FOUND))
    out.print(f"wrote {target}")
    if best.deviation(wanted) > CLOSE:
        missed = ", ".join(f"{test} is {excess_in_words(test, best, wanted)}" for test in wanted)
        err.print(f"{case.name}: no trial of {len(done)} is within {percent(CLOSE)}; written is the best one: {missed}")
        raise typer.Exit(FAILED)


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
        if as_json:
            raise CaseError(["--json: is for the tables without a run, not allowed with --ucs or --tension"])
        match_strengths(case, load_disks(case, changes), targets, changes, seeds, output, loading)
        return
    if given := [*(["--seeds"] if seeds != SEEDS else []), *loading.given]:
        raise CaseError([f"{', '.join(given)}: for tests of samples, give --ucs or --tension"])
    from dembound.disks.scene import build
    from dembound.kinds.disks.micro_macro import describe_materials, material_rows, materials_of, packing_line

    scene = build(load_disks(case, changes))
    found = describe_materials(scene)
    if as_json:
        print_lines(*json.dumps(found, indent=2, allow_nan=False).splitlines())
        return
    for each, own in zip(found, materials_of(scene), strict=True):
        if own.layer:
            out.print(f"layer {own.layer}")
        out.print(packing_line(own.ground))
        for title, rows in material_rows(each):
            out.print()
            print_rows(title, rows)
        out.print()


@app.command("packing", rich_help_panel=MORE)
def packing(
    cases: Cases,
    output: Annotated[Path, PICTURE] = Path("packing.png"),
    title: PictureTitle = None,
    side: Annotated[Side, typer.Option(help="Side whose particles are marked.")] = Side.right,
    brick: Annotated[bool, typer.Option("--brick", help="Show the first case's whole brick with its seams.")] = False,
    changes: Settings = None,
) -> None:
    """Draw one side of the packing of each case, or one brick (PNG)."""
    from dembound.disks.scene import build
    from dembound.plot.packing import plot_brick, plot_patterns

    loaded = [load_disks(path, changes) for path in cases]
    if brick:
        shown = build(loaded[0]).ground.brick
        figure = plot_brick(shown.positions, shown.radii, shown.edge_rows, shown.size, shown.pairs, shown.images)
    else:
        scenes = {case.name: build(case) for case in loaded}
        figure = plot_patterns(
            {
                name: (scene.assembly.positions, scene.assembly.radii, _edge_of(scene, side.value).nodes)
                for name, scene in scenes.items()
            }
        )
    leave(figure, output, title)


def _edge_of(scene: DiskScene, side: str) -> Edge:
    """A side of the scene; periodic sides have no particles."""
    if side not in scene.edges:
        raise CaseError([f"--side: is {side}, which is periodic in {scene.case.name}; here: {', '.join(scene.edges)}"])
    return scene.edges[side]

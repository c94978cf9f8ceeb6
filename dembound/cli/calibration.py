"""The command calibrate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from typer import Argument, Option

from dembound.cli.app import (
    Name,
    Output,
    Settings,
    Side,
    Threads,
    app,
    load_disks,
    prepare_computing,
    text_for,
    writable,
)
from dembound.cli.console import compact_table, out, print_written
from dembound.cli.options import leave, with_tables
from dembound.errors import CaseError
from dembound.studies.asked import Calibrating

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase
    from dembound.studies.calibration import Calibration

CALIBRATED = "_calibrated"
"""Suffix of the name of a calibrated case."""

OneCase = Annotated[Path, Argument(metavar="CASE", help="A case file (TOML).")]


WaveType = Literal["p", "s"]
"""Kinds of waves to calibrate for."""


@app.command("calibrate")
@with_tables
def calibrate_sides(
    case: OneCase,
    *,
    boundary: Annotated[Side | None, Option("--boundary", "-b", help="Side to calibrate, without --all.")] = None,
    every: Annotated[
        bool, Option("--all", "-a", help="Every side with dashpots, for both waves that can move it.")
    ] = False,
    wave: Annotated[WaveType | None, Option(help="Wave; by default that which runs towards this side, else P.")] = None,
    how: Calibrating,
    output: Output = Path("results"),
    calibrated: Annotated[
        Path | None,
        Option(metavar="FILE", help="Calibrated case; by default NAME_calibrated.toml.", callback=writable),
    ] = None,
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
) -> None:
    """Find the factors β with which viscous sides absorb plane waves.

    Prints β and M_out/M_in of every pass; writes the passes in HDF5, a picture of them, and the case with β in place.

    All other lines of the case remain. A calibrated case that differs in more than the β found is not replaced.
    """
    from dembound.casefile.edit import edited
    from dembound.files import write_text
    from dembound.studies.all_sides import calibrate_all, changes_of, summary_of
    from dembound.studies.calibration import calibrate

    _one_or_all(boundary, every, wave)
    prepare_computing(threads)
    loaded = load_disks(case, changes, name)
    plain = loaded.name.removesuffix(CALIBRATED)
    folder = output / f"{plain}_calibration"
    target = calibrated or case.with_name(f"{plain}{CALIBRATED}.toml")
    text = text_for(target, case, loaded, changes)
    _require_no_other(target, text, _factors(loaded, boundary, wave))
    if boundary is None:
        found = calibrate_all(loaded, how, report=lambda each: _print_pass(each, f"{each.side}, "))
        _print_table(found)
        records = [folder / f"{each.side}_{each.motion}" / "calibration.h5" for each in found]
        _leave(found, summary_of(found), folder, records)
    else:
        one = calibrate(loaded, boundary.value, how, motion=wave, report=_print_pass)
        _print_result(one)
        found = [one]
        folder = folder.with_name(f"{folder.name}_{one.side}_{one.motion}_{one.method}")
        _leave(found, one.summary(), folder, [folder / "calibration.h5"])
    write_text(target, edited(text, changes_of(found)))
    print_written(target)


def _factors(case: DiskCase, boundary: Side | None, wave: WaveType | None) -> list[str]:
    """The keys of the factors that are calibrated; raises CaseError if the side has none, or cannot move."""
    from dembound.studies.all_sides import factors_of
    from dembound.studies.calibration import calibrated_motion

    if boundary is None:
        return [f"boundary.{side}.beta_{motion}" for side, motion in factors_of(case)]
    motion = calibrated_motion(case, boundary.value, wave)
    return [f"boundary.{boundary.value}.beta_{motion}"]


def _require_no_other(target: Path, text: str, factors: Sequence[str]) -> None:
    """Raise CaseError if there is a file that is not this text with other values of the factors."""
    from dembound.casefile.edit import edited

    if not target.exists():
        return
    same = dict.fromkeys(factors, 1.0)
    try:
        replaced = edited(target.read_bytes().decode("utf-8-sig"), same) == edited(text, same)
    except (CaseError, UnicodeDecodeError):
        replaced = False
    if not replaced:
        said = f"exists already and differs from the case by more than {', '.join(factors)}"
        advice = "calibrate that file to change these in it, or give another --calibrated FILE or --name"
        raise CaseError([f"{target}: {said}; {advice}"])


def _one_or_all(boundary: Side | None, every: bool, wave: WaveType | None) -> None:
    """Raise CaseError if neither or both are given."""
    if not every and boundary is None:
        raise CaseError(["--boundary: is missing; name a side, or give --all"])
    given = {"--boundary": boundary, "--wave": wave}
    if every and (both := [option for option, value in given.items() if value is not None]):
        raise CaseError([f"{option}: is for one side, not allowed together with --all" for option in both])


def _leave(found: Sequence[Calibration], summary: Mapping[str, Any], folder: Path, records: Sequence[Path]) -> None:
    """Write the passes of each calibration, a summary, and a picture of the passes; prints each file.

    records : the file of each.
    """
    from dembound.files import make_folder, remove
    from dembound.plot.stability import plot_convergence
    from dembound.results.text_files import write_json

    make_folder(folder)
    for each, record in zip(found, records, strict=True):
        make_folder(record.parent)
        each.write(record)
    write_json(folder / "summary.json", summary)
    print_written(*records, folder / "summary.json")
    picture = folder / "convergence.png"
    remove(picture)  # one of an earlier calibration with another method
    if found[0].beta:
        leave(plot_convergence(records), picture)


def _print_pass(found: Calibration, of: str = "") -> None:
    from dembound.boundaries.description import FACTORS

    number = len(found.beta)
    out.print(
        f"{of}pass {number:2d}: {FACTORS[found.factor]} = {found.beta[-1]:.6f}, "
        f"M_out = {found.outgoing[-1]:.6f} m/s, M_out/M_in = {found.ratio[-1]:.6f}"
    )


def _print_table(found: Sequence[Calibration]) -> None:
    """One line per factor: side and wave, old and new value, and M_out/M_in; below what sides return, if compared."""
    from dembound.studies.all_sides import changes_of

    table = compact_table("key", "side", "β", "before", "M_out/M_in", "passes", title=found[0].case.name)
    for (key, result), each in zip(changes_of(found).items(), found, strict=True):
        before = each.case.boundary[each.side].factors[each.motion]
        ratio = f"{each.ratio[-1]:.6f}" if each.ratio else "–"
        given = before if before == "matched" else f"{before:g}"
        table.add_row(key, each.kind, f"{result:g}", given, ratio, str(len(each.beta)))
    out.print(table)
    for key, each in zip(changes_of(found), found, strict=True):
        if each.compared:
            out.print(f"{key} {each.compared}")


def _print_result(found: Calibration) -> None:
    from dembound.boundaries.description import FACTORS

    out.print(f"{found.case.name}, {found.side} ({found.kind}): {FACTORS[found.factor]} = {found.result:g}")
    if found.method == "homogenised":
        out.print("from the brick's homogenised wave speed and the side's ΣD/H; no wave was run")
        return
    out.print(f"calibrated on {found.particles:,} particles, {found.steps:,} steps:")
    for line in (*found.shortened, *([found.compared] if found.compared else [])):
        out.print(f"  {line}")

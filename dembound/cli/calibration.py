"""The command calibrate."""

import json
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from dembound.casefile import to_toml
from dembound.cli.app import Name, Output, Settings, Side, Threads, app, load_disks, out, use_threads
from dembound.disks.facts import FACTORS
from dembound.kinds import with_changes
from dembound.plot.convergence import plot_convergence
from dembound.plot.style import save
from dembound.studies.calibration import Calibration, calibrate

OneCase = Annotated[Path, typer.Argument(metavar="CASE", help="A case file (TOML).")]


class WaveType(StrEnum):
    """Kinds of waves to calibrate for."""

    p = "p"
    s = "s"


class CalibrationMethod(StrEnum):
    """Ways to find β."""

    impedance = "impedance"
    ratio = "ratio"
    homogenised = "homogenised"


@app.command("calibrate", rich_help_panel="Cases")
def calibrate_side(
    case: OneCase,
    boundary: Annotated[Side, typer.Option("--boundary", "-b", help="Side to calibrate.")],
    wave: Annotated[
        WaveType | None, typer.Option(help="P or S; by default what runs towards this side, else P.")
    ] = None,
    method: Annotated[
        CalibrationMethod,
        typer.Option(
            help="impedance: solve for β, then check; ratio: multiply by M_out/M_in; "
            "homogenised: from the brick alone, no run."
        ),
    ] = CalibrationMethod.impedance,
    start: Annotated[float | None, typer.Option(help="First β; by default the case's own.")] = None,
    tolerance: Annotated[float, typer.Option(help="Largest |M_out/M_in − 1| to accept.", min=1e-9)] = 1e-3,
    full: Annotated[bool, typer.Option("--full", help="Use the whole scene instead of a short strip.")] = False,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
) -> None:
    """Find the β with which a viscous side absorbs, or lets in, a plane wave whole.

    Prints β and M_out/M_in of every pass; leaves the calibrated case, the passes in HDF5 and a picture of them.
    """
    use_threads(threads)
    loaded = load_disks(case, changes, name)
    found = calibrate(
        loaded,
        boundary.value,
        motion=wave.value if wave else None,  # type: ignore[arg-type]
        method=method.value,  # type: ignore[arg-type]
        start=start,
        tolerance=tolerance,
        full=full,
        report=_print_pass,
    )
    folder = output / f"{loaded.name}_calibration_{found.side}_{found.motion}_{found.method}"
    _print_result(found)
    for path in _leave(found, folder):
        out.print(f"wrote {path}")


def _leave(found: Calibration, folder: Path) -> Iterator[Path]:
    """Write what a calibration found, yielding each file."""
    folder.mkdir(parents=True, exist_ok=True)
    found.write(folder / "calibration.h5")
    yield folder / "calibration.h5"
    (folder / "summary.json").write_text(json.dumps(found.summary(), indent=2) + "\n")
    yield folder / "summary.json"
    changed = with_changes(found.case, {f"boundary.{found.side}.{found.factor}": found.result})
    calibrated = folder / f"{found.case.name}_calibrated.toml"
    calibrated.write_text(to_toml(changed, folder), encoding="utf-8")
    yield calibrated
    if found.beta:
        save(plot_convergence([folder / "calibration.h5"]), folder / "convergence.png")
        yield folder / "convergence.png"


def _print_pass(found: Calibration) -> None:
    number = len(found.beta)
    out.print(
        f"pass {number:2d}: {FACTORS[found.factor]} = {found.beta[-1]:.6f}, "
        f"M_out = {found.outgoing[-1]:.6f} m/s, M_out/M_in = {found.ratio[-1]:.6f}"
    )


def _print_result(found: Calibration) -> None:
    out.print(f"{found.case.name}, {found.side} ({found.kind}): {FACTORS[found.factor]} = {found.result:.6f}")
    if found.method == "homogenised":
        out.print("from the brick's homogenised wave speed and the side's ΣD/H; no wave was run")
        return
    out.print(f"calibrated on {found.particles:,} particles, {found.steps:,} steps:")
    for line in found.shortened:
        out.print(f"  {line}")

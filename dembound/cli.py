"""The command line. Only this file prints and exits; what it does lives elsewhere."""

import json
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numba
import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from dembound import __version__
from dembound.boundaries import SIDES
from dembound.boundaries.support import Edge
from dembound.calibrate import Calibration, calibrate
from dembound.case import STARTER, Case, load, to_toml, with_changes
from dembound.check import check
from dembound.errors import CaseError, DemboundError
from dembound.packings.cache import cache_folder, clear
from dembound.plot.boundary import plot_boundary
from dembound.plot.convergence import plot_convergence
from dembound.plot.histories import plot_histories
from dembound.plot.packing import plot_brick, plot_patterns
from dembound.plot.style import save
from dembound.run import foresee, run_case
from dembound.scene import Scene, build
from dembound.simulate import Simulation
from dembound.view import view

EXIT_CODES = """
Exit codes: 0 done; 1 a bug; 2 bad input, nothing was written; 3 a run or calibration failed; 4 a packing could
not be made; 5 a file could not be read or written; 130 stopped with Ctrl-C.
"""
CANNOT_WRITE = 5

app = typer.Typer(
    name="dembound",
    help="Waves in bonded particles, with artificial boundaries that really absorb.",
    epilog=EXIT_CODES,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
out = Console(highlight=False, soft_wrap=True)
err = Console(stderr=True, highlight=False, soft_wrap=True)

Cases = Annotated[list[Path], typer.Argument(metavar="CASE...", help="Case files (TOML).")]
OneCase = Annotated[Path, typer.Argument(metavar="CASE", help="A case file (TOML).")]
Output = Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")]
Threads = Annotated[int | None, typer.Option(min=1, help="Cores to use; all by default. Results do not depend on it.")]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change a key, e.g. boundary.right.beta_p=0.8. May be repeated."),
]
Name = Annotated[str | None, typer.Option(help="Name of the results folder; by default the case file's.")]
Side = StrEnum("Side", {side: side for side in SIDES})  # type: ignore[misc]

RIGHT = Side("right")


class WaveType(StrEnum):
    """Kinds of waves to calibrate for."""

    p = "p"
    s = "s"


class Field(StrEnum):
    """What moves the disks of a snapshot."""

    velocity = "velocity"
    displacement = "displacement"


class CalibrationMethod(StrEnum):
    """Ways to find β."""

    impedance = "impedance"
    ratio = "ratio"
    homogenised = "homogenised"


@app.callback(invoke_without_command=True)
def _version(
    version: Annotated[bool, typer.Option("--version", help="Print the version and stop.")] = False,
) -> None:
    if version:
        out.print(f"dembound {__version__}")
        raise typer.Exit


@app.command("new", rich_help_panel="Cases")
def new(
    path: Annotated[Path, typer.Argument(help="File to write.")] = Path("case.toml"),
) -> None:
    """Write a commented starter case."""
    if path.exists():
        raise CaseError([f"{path}: exists already, give another name"])
    path.write_text(STARTER, encoding="utf-8")
    out.print(f"wrote {path}; try: dembound check {path}")


@app.command("check", rich_help_panel="Cases")
def check_cases(cases: Cases, changes: Settings = None, threads: Threads = None) -> None:
    """Say what would be run: particles, bonds, time step, memory, time, resolution. Writes nothing."""
    _use(threads)
    for case in [_load(path, changes) for path in cases]:
        facts, warnings = check(case)
        table = Table(title=f"{case.name}: {case.title}" if case.title else case.name, show_header=False)
        for name, value in facts.items():
            table.add_row(name, value)
        out.print(table)
        for warning in warnings:
            err.print(f"warning: {warning}")


@app.command("run", rich_help_panel="Cases")
def run(
    cases: Cases,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
) -> None:
    """Run cases one after another; each leaves its folder of results.

    All case files are read before the first is run, so a mistake in the last one costs nothing.
    """
    _use(threads)
    loaded = [_load(path, changes, name) for path in cases]
    names = [case.name for case in loaded]
    if len(set(names)) < len(names):
        raise CaseError(["CASE: two case files have the same name, so one would overwrite the other's results"])
    for case in loaded:
        foresee(case)
    for case in loaded:
        with _progress(case.name) as step:
            folder = run_case(case, output, step)
        out.print(f"{case.name}: results in {folder}")


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
    _use(threads)
    loaded = _load(case, changes, name)
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


@app.command("plot", rich_help_panel="Results")
def plot(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write (PNG).")] = Path("plot.png"),
    quantity: Annotated[str, typer.Option(help="velocity or displacement.")] = "velocity",
    monitor: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Show this monitor only. May be repeated.")
    ] = None,
    boundary: Annotated[
        Side | None, typer.Option(help="Show this side's diameters and peak velocities instead.")
    ] = None,
) -> None:
    """Overlay the histories of several runs, or the passes of several calibrations, in one picture."""
    files = [_results_file(path) for path in results]
    if quantity not in ("velocity", "displacement"):
        raise CaseError([f"--quantity: is {quantity}, must be velocity or displacement"])
    if all(file.name == "calibration.h5" for file in files):
        figure = plot_convergence(files)
    elif boundary is not None:
        figure = plot_boundary(files, boundary.value)
    else:
        figure = plot_histories(files, quantity=quantity, monitors=monitor or None)  # type: ignore[arg-type]
    save(figure, output)
    out.print(f"wrote {output}")


@app.command("view", rich_help_panel="Results")
def view_disks(
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="A run's result folder or HDF5 file.")],
    snapshot: Annotated[int, typer.Option(help="Number of the snapshot to begin with; −1 is the last.")] = -1,
    field: Annotated[Field, typer.Option(help="What colours the disks.")] = Field.velocity,
    picture: Annotated[Path | None, typer.Option(help="Picture to write (PNG) instead of opening a window.")] = None,
) -> None:
    """Show the disks of a run in a window to zoom into, with a slider over its snapshots."""
    view(_results_file(results), snapshot, field.value, picture)
    if picture is not None:
        out.print(f"wrote {picture}")


@app.command("packing", rich_help_panel="Cases")
def packing(
    cases: Cases,
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write (PNG).")] = Path("packing.png"),
    side: Annotated[Side, typer.Option(help="Side whose particles are marked.")] = RIGHT,
    brick: Annotated[bool, typer.Option("--brick", help="Show the first case's whole brick with its seams.")] = False,
    changes: Settings = None,
) -> None:
    """Draw packings: one side of each case next to each other, or one brick."""
    loaded = [_load(path, changes) for path in cases]
    if brick:
        shown = build(loaded[0]).ground.brick
        figure = plot_brick(shown.positions, shown.radii, shown.rows, shown.size, shown.pairs, shown.images)
    else:
        scenes = {case.name: build(case) for case in loaded}
        figure = plot_patterns(
            {
                name: (scene.assembly.positions, scene.assembly.radii, _edge_of(scene, side.value).nodes)
                for name, scene in scenes.items()
            }
        )
    save(figure, output)
    out.print(f"wrote {output}")


def _edge_of(scene: Scene, side: str) -> Edge:
    """A side that exists; a periodic one has no particles of its own."""
    if side not in scene.edges:
        raise CaseError([f"--side: is {side}, which is periodic in {scene.case.name}; here: {', '.join(scene.edges)}"])
    return scene.edges[side]


@app.command("cache", rich_help_panel="Results")
def cache(
    delete: Annotated[bool, typer.Option("--clear", help="Delete all cached bricks.")] = False,
) -> None:
    """Show where packed bricks are kept (DEMBOUND_CACHE moves it), or delete them."""
    out.print(str(cache_folder()))
    if delete:
        out.print(f"deleted {clear()} bricks")


def _load(path: Path, changes: list[str] | None, name: str | None = None) -> Case:
    """Read a case file, change keys and rename it as the options say."""
    case = load(path)
    if changes:
        case = with_changes(case, dict(_setting(text) for text in changes))
    return replace(case, name=name) if name else case


def _setting(text: str) -> tuple[str, Any]:
    """Key and value of ``--set key=value``; the value is TOML, or else a plain string."""
    key, equals, value = text.partition("=")
    if not equals or not key:
        raise CaseError([f"--set: is {text}, must be KEY=VALUE, e.g. boundary.right.beta_p=0.8"])
    try:
        return key.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key.strip(), value.strip()


def _results_file(path: Path) -> Path:
    """The HDF5 file a results argument stands for."""
    for candidate in (path, path / "run.h5", path / "calibration.h5"):
        if candidate.is_file():
            return candidate
    raise CaseError([f"{path}: holds no results, must be a folder with run.h5 or calibration.h5"])


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
        f"pass {number:2d}: {found.factor} = {found.beta[-1]:.6f}, "
        f"M_out = {found.outgoing[-1]:.6f} m/s, M_out/M_in = {found.ratio[-1]:.6f}"
    )


def _print_result(found: Calibration) -> None:
    out.print(f"{found.case.name}, {found.side} ({found.kind}): {found.factor} = {found.result:.6f}")
    if found.method == "homogenised":
        out.print("from the brick's homogenised wave speed and the side's ΣD/H; no wave was run")
        return
    out.print(f"calibrated on {found.particles} particles, {found.steps} steps: {'; '.join(found.shortened)}")


def _use(threads: int | None) -> None:
    """Set the number of threads, as far as there are that many."""
    if threads is not None:
        most = numba.get_num_threads()
        if threads > most:
            raise CaseError([f"--threads: is {threads}, must not be above {most}, the cores here"])
        numba.set_num_threads(threads)


@contextmanager
def _progress(name: str):  # type: ignore[no-untyped-def]
    """A progress bar with rate and time left on a terminal, nothing elsewhere."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %  {task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as progress:
        task = progress.add_task(name, total=None, rate="")

        def step(simulation: Simulation, steps: int) -> None:
            speed = progress.tasks[0].speed
            rate = f"{speed * simulation.scene.count / 1e6:.0f} M particle-steps/s" if speed else ""
            progress.update(task, completed=simulation.steps, total=steps, rate=rate)

        yield step


def main() -> None:
    """Run the command line; every failure a user can cause is one message and its exit code."""
    try:
        app()
    except DemboundError as error:
        source = f"{error.source}: " if isinstance(error, CaseError) and error.source else ""
        for line in str(error).splitlines():
            err.print(f"{source}{line}", style="red", markup=False)
        sys.exit(error.exit_code)
    except OSError as error:  # a folder that is not there, no permission, a full disk
        err.print(f"{error.filename or 'output'}: {error.strerror or error}", style="red", markup=False)
        sys.exit(CANNOT_WRITE)

"""Commands without a whole run: exact solutions, dispersion on bars, stability of the time step, packings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from rich.table import Table
from rich.text import Text
from typer import Argument, Option

from dembound.cli.app import (
    MORE,
    PICTURE,
    Cases,
    Name,
    Output,
    PictureTitle,
    Settings,
    Side,
    Threads,
    app,
    ending_in,
    load_case,
    load_disks,
    prepare_computing,
)
from dembound.cli.calibration import OneCase
from dembound.cli.console import compact_table, err, out, print_written
from dembound.cli.options import CurveTable, leave
from dembound.errors import CaseError, RunError

if TYPE_CHECKING:
    from dembound.boundaries.edge import Edge
    from dembound.disks.scene import DiskScene
    from dembound.exact.bar import Lattice, Speed
    from dembound.plot.reflection import Points
    from dembound.plot.stability import Line
    from dembound.studies.stability import Stability


@app.command("exact", rich_help_panel=MORE)
def exact(
    path: Annotated[Path, Argument(metavar="CASE", help="Case file (TOML) of a problem with an exact solution.")],
    problem: Annotated[
        str | None, Option(help="lamb, cavity, garvin or scattering; by default that which holds longest.")
    ] = None,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
) -> None:
    """Write the exact solution at the monitors of a case, if known.

    Known are Lamb's and Garvin's problem, and a circular hole under a pressure or under a plane wave.

    The solution is plotted and compared like a run. Its folder is named after the case with "_exact", or by --name.
    """
    from dembound.accuracy.of_disks.exact import write_exact

    case = load_disks(path, changes, name or f"{path.stem}_exact")
    folder = output / case.name
    found = write_exact(case, folder / "run.h5", problem)
    for monitor, end in found.until.items():
        if end < case.run.duration:
            out.print(f"{case.name}: {monitor} up to {end:.4g} s, when scattered waves come back from the free surface")
    out.print(f"{case.name}: {found.sentence}, histories in {folder}")


HORIZONS, SPACINGS, TIME_STEPS = (1, 2, 3, 4, 8), (0.005,), (1e-6,)
"""Spacing and step as in L figs 5 and 7."""

WAVE_SPEED = 2763.0
"""L's biotite granite, √(20 GPa / 2620 kg/m³), m/s."""

HEADS = ("horizon", "Δx (m)", "Δt (s)", "cΔt/Δx", "stable up to", "phase", "group")

CHECKED = 12
"""Number of waves to simulate; their wave numbers are evenly spaced up to the shortest wave's."""


def _several(default: Sequence[float]) -> str:
    """Help text of an option that may be repeated."""
    return f"May be repeated; by default {', '.join(f'{value:g}' for value in default)}."


@app.command("dispersion", rich_help_panel=MORE)
def dispersion(
    cases: Annotated[list[Path] | None, Argument(metavar="CASE", help="Case files of bars.")] = None,
    horizons: Annotated[
        list[int] | None,
        Option("--horizon", help=f"Neighbours on either side; 1: central differences. {_several(HORIZONS)}"),
    ] = None,
    spacings: Annotated[
        list[float] | None, Option("--spacing", help=f"Distance Δx of the nodes (m). {_several(SPACINGS)}")
    ] = None,
    time_steps: Annotated[
        list[float] | None, Option("--time-step", help=f"Time step Δt (s); 0: exact in time. {_several(TIME_STEPS)}")
    ] = None,
    wave_speed: Annotated[float | None, Option(help=f"Speed c of long waves (m/s); by default {WAVE_SPEED:g}.")] = None,
    check: Annotated[bool, Option("--check", help="Simulate some waves, too.")] = False,
    output: Annotated[Path, PICTURE] = Path("dispersion.png"),
    title: PictureTitle = None,
    table: CurveTable = None,
    changes: Settings = None,
) -> None:
    """Print wave speeds on bars, and nodes per wavelength.

    Of peridynamics and of central differences, for the bars of cases, or for all combinations of the options.
    """
    from dembound.plot.reflection import plot_dispersion
    from dembound.studies.dispersion import lattices, lattices_of, write_table

    own = {"--horizon": horizons, "--spacing": spacings, "--time-step": time_steps, "--wave-speed": wave_speed}
    if cases:
        _refuse(own, "is given by the case, change it with --set")
        found = [lattice for path in cases for lattice in lattices_of(load_case(path, changes))]
        shown = list(dict.fromkeys(found))  # equal ones only once
    else:
        _refuse({"--set": changes}, "changes a case, and none is given")
        speed = WAVE_SPEED if wave_speed is None else wave_speed
        shown = lattices(horizons or HORIZONS, spacings or SPACINGS, time_steps or TIME_STEPS, speed)
    out.print(_overview(shown))
    leave(plot_dispersion(shown, _simulated(shown) if check else ()), output, title)
    if table is not None:
        write_table(shown, table)
        print_written(table)


def _refuse(options: Mapping[str, object], why: str) -> None:
    """Raise CaseError if one of the options was given, with a line for each."""
    problems = [f"{option}: {why}" for option, value in options.items() if value not in (None, [])]
    if problems:
        raise CaseError(problems)


def _overview(shown: Sequence[Lattice]) -> Table:
    """Courant numbers, their limits, and how many spacings a wavelength needs."""
    from dembound.plot.reflection import horizon_in_words

    overview = compact_table(*HEADS, title="Spacings per wavelength from which on waves run within 1 % of c")
    for lattice in shown:
        limit = lattice.courant_limit
        sizes = (horizon_in_words(lattice), f"{lattice.spacing:g}", f"{lattice.time_step:g}")
        needed = (_needed(lattice, "phase"), _needed(lattice, "group"))
        overview.add_row(*sizes, f"{lattice.courant:.4f}", f"{limit:.4f}", *needed)
    return overview


def _needed(lattice: Lattice, of: Speed) -> str:
    """Spacings per wavelength for 1 %, in words."""
    from dembound.exact.bar import cells_per_wavelength

    if not lattice.stable:
        return "unstable"
    return f"{cells_per_wavelength(lattice.horizon, lattice.courant, of=of, shares=lattice.shares):.1f}"


def _simulated(shown: Sequence[Lattice]) -> list[Points]:
    """Points computed by simulation, for stable lattices; prints how far they are from the formula."""
    import numpy as np

    from dembound.plot.reflection import name
    from dembound.studies.dispersion import measure

    points = []
    parts = np.arange(1, CHECKED + 1) / CHECKED
    for lattice in shown:
        wavenumber = parts * lattice.shortest if lattice.stable and lattice.time_step > 0.0 else np.zeros(0)
        frequency = measure(lattice, wavenumber)
        points.append((wavenumber, frequency))
        if len(frequency):
            error = np.abs(frequency / lattice.frequency(wavenumber) - 1.0).max()
            out.print(f"{name(lattice)}: {len(frequency)} simulated frequencies differ by at most {error:.1e}")
    return points


@app.command("stability", rich_help_panel=MORE)
def stability(
    case: OneCase,
    steps: Annotated[int | None, Option(help="Steps of noise at the case's own time step.", min=1)] = None,
    full: Annotated[bool, Option("--full", help="The whole scene, not fewer copies of its brick.")] = False,
    strength: Annotated[bool, Option("--strength", help="How near the ground is to failure, not the step.")] = False,
    tolerance: Annotated[
        float | None, Option(help="Relative width of brackets of --strength; by default 0.02.")
    ] = None,
    output: Annotated[
        Path | None,
        Option(
            "--output",
            "-o",
            help="Picture (PNG), by default stability.png; of --strength the table (CSV), strength.csv.",
            callback=ending_in(".png", ".csv"),
        ),
    ] = None,
    title: PictureTitle = None,
    table: CurveTable = None,
    changes: Settings = None,
    threads: Threads = None,
) -> None:
    """Measure the largest stable time step of a scene, by noise.

    Also checks whether the energy of noise grows at the case's own step.

    Loads and waves are left out. Ends with exit code 3 if the case's own step is not stable.

    With --strength the body settles with strengths divided by F until it fails, and is pushed sideways until it fails.

    The sides of the static stage stay in the push. Ends with exit code 3 if the body does not stand as it is.
    """
    from dembound.cli.strength import measure_strength

    of_step = {"--steps": steps, "--full": full or None, "--title": title, "--table": table}
    _refuse(of_step if strength else {"--tolerance": tolerance}, f"is {'not ' if strength else ''}for --strength")
    ending = ".csv" if strength else ".png"
    if output is not None and output.suffix.lower() != ending:
        raise CaseError([f"--output: is {output}, must end in {ending}"])
    prepare_computing(threads)
    if strength:
        measure_strength(
            load_disks(case, changes), 0.02 if tolerance is None else tolerance, output or Path("strength.csv")
        )
        return
    from dembound.plot.stability import plot_stability
    from dembound.studies.stability import measure

    loaded = load_case(case, changes)
    found, words = measure(loaded, steps=steps, full=full, report=lambda line: err.print(line))
    out.print(_stability_overview(found, f"{loaded.name}: {words[0]}"))
    done = max(run.course.steps[-1] for each in found for run in each.long_runs)
    for line in [*words[1:], f"{done:,} steps at the case's own step"]:
        out.print(f"  {line}")
    short, long = _lines(found)
    figure = plot_stability(short, long, f"Noise in {loaded.name}: {words[0]}")
    leave(figure, output or Path("stability.png"), title, table)
    _fail_if_unstable(found)


def _stability_overview(found: Sequence[Stability], title: str) -> Table:
    """One line for each law or stage and part: limits, the case's own step, and how its energy changed."""
    from dembound.studies.stability import RESOLUTION

    overview = compact_table("", "limit (s)", "measured", "own step", "energy", "rise", "", title=title)
    for each in found:
        limit = each.trial.limit
        measured = f"> {each.below / limit:.4g}"
        if each.measured < float("inf"):
            measured = f"{each.measured / limit:.{4 if each.width < 2.0 * RESOLUTION else 2}f}"
        for run in each.long_runs:
            name = each.trial.name if len(each.long_runs) == 1 else f"{each.trial.name}, {run.part}"
            last = f"{run.shown[1][-1]:.4g}"
            own = f"{each.trial.step / limit:.4f}"
            state = "stable" if each.is_stable else "UNSTABLE"
            overview.add_row(name, f"{limit:.5g}", measured, own, last, f"{run.rise:.1e}", state)
    overview.caption = Text(
        "measured: largest stable step over the limit; own step: the case's over the limit;\n"
        "energy: at the end over the start, with energy taken by boundaries where contacts may\n"
        "open (if unstable: kinetic energy); rise: largest energy over the start, less 1"
    )
    overview.caption_justify = "left"
    return overview


def _lines(found: Sequence[Stability]) -> tuple[list[Line], list[Line]]:
    """The runs around the limit, and those at the case's own step, for the picture."""
    from dembound.plot.stability import Line

    short, long = [], []
    for group, each in enumerate(found):
        of_limit = each.below / each.trial.limit, each.above / each.trial.limit
        for share, course, dashed in zip(of_limit, (each.growing, each.calm)[::-1], (True, False), strict=True):
            if course.steps:
                name = f"{each.trial.name}: {share:.4f} of the limit"
                short.append(Line(name, group, course.steps, course.kinetic, dashed))
        for index, run in enumerate(each.long_runs):
            name = f"{each.trial.name}, {run.part}: {each.trial.step / each.trial.limit:.4f} of the limit"
            long.append(Line(name, group, *run.shown, index > 0))
    return short, long


def _fail_if_unstable(found: Sequence[Stability]) -> None:
    """Raise RunError, with a line for each law or stage that is not stable at the case's own step."""
    lines = []
    for each in (each for each in found if not each.is_stable):
        said = f"not stable at the case's own step of {each.trial.step:.6g} s"
        lines.append(f"{each.trial.name}: {said}; the largest stable one is {each.measured:.6g} s")
    if lines:
        raise RunError("\n".join(lines))


@app.command("packing", rich_help_panel=MORE)
def packing(
    cases: Cases,
    output: Annotated[Path, PICTURE] = Path("packing.png"),
    title: PictureTitle = None,
    side: Annotated[Side, Option(help="Side whose particles are marked.")] = Side.right,
    brick: Annotated[bool, Option("--brick", help="The first case's whole brick.")] = False,
    changes: Settings = None,
) -> None:
    """Draw a side of packings, or a brick (PNG)."""
    from dembound.disks.scene import build
    from dembound.plot.packing import plot_brick, plot_patterns

    loaded = [load_disks(path, changes) for path in cases]
    if brick:
        shown = build(loaded[0]).ground.brick
        figure = plot_brick(shown.positions, shown.radii, shown.edge_rows, shown.size, shown.pairs, shown.images)
    else:
        scenes = {case.name: build(case) for case in loaded}
        edges = {name: _edge_of(scene, side.value).nodes for name, scene in scenes.items()}
        bodies = {name: scene.assembly for name, scene in scenes.items()}
        figure = plot_patterns({name: (body.positions, body.radii, edges[name]) for name, body in bodies.items()})
    leave(figure, output, title)


def _edge_of(scene: DiskScene, side: str) -> Edge:
    """A side of the scene; periodic sides have no particles."""
    if side not in scene.edges:
        raise CaseError([f"--side: is {side}, which is periodic in {scene.case.name}; here: {', '.join(scene.edges)}"])
    return scene.edges[side]

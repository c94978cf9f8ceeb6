"""The commands exact and dispersion: solutions without a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import MORE, PICTURE, Name, Output, PictureTitle, Settings, app, load_case, load_disks
from dembound.cli.console import compact_table, out
from dembound.cli.options import CurveTable, leave
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.exact.dispersion import Lattice, Speed
    from dembound.plot.dispersion import Points


@app.command("exact", rich_help_panel=MORE)
def exact(
    path: Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML) of a problem with an exact solution.")],
    problem: Annotated[
        str | None, typer.Option(help="lamb, cavity, garvin or scattering; absent: the one that holds for longest.")
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
    cases: Annotated[
        list[Path] | None, typer.Argument(metavar="CASE", help="Case files (TOML) of bars, to show their lattices.")
    ] = None,
    horizons: Annotated[
        list[int] | None,
        typer.Option("--horizon", help=f"Neighbours on either side; 1: central differences. {_several(HORIZONS)}"),
    ] = None,
    spacings: Annotated[
        list[float] | None, typer.Option("--spacing", help=f"Distance Δx of the nodes (m). {_several(SPACINGS)}")
    ] = None,
    time_steps: Annotated[
        list[float] | None,
        typer.Option("--time-step", help=f"Time step Δt (s); 0: exact in time. {_several(TIME_STEPS)}"),
    ] = None,
    wave_speed: Annotated[
        float | None, typer.Option(help=f"Speed c of long waves (m/s); by default {WAVE_SPEED:g}.")
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Simulate some waves, and print their differences.")] = False,
    output: Annotated[Path, PICTURE] = Path("dispersion.png"),
    title: PictureTitle = None,
    table: CurveTable = None,
    changes: Settings = None,
) -> None:
    """Print wave speeds on bars, and the nodes a wavelength needs.

    Of peridynamics and of central differences, for the bars of cases, or for all combinations of the options.
    """
    from dembound.plot.dispersion import plot_dispersion
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
        out.print(f"wrote {table}")


def _refuse(options: Mapping[str, object], why: str) -> None:
    """Raise CaseError if one of the options was given, with a line for each."""
    problems = [f"{option}: {why}" for option, value in options.items() if value not in (None, [])]
    if problems:
        raise CaseError(problems)


def _overview(shown: Sequence[Lattice]) -> Table:
    """Courant numbers, their limits, and how many spacings a wavelength needs."""
    from dembound.plot.dispersion import horizon_in_words

    overview = compact_table(*HEADS, title="Spacings per wavelength from which on waves run within 1 % of c")
    for lattice in shown:
        limit = lattice.courant_limit
        sizes = (horizon_in_words(lattice), f"{lattice.spacing:g}", f"{lattice.time_step:g}")
        needed = (_needed(lattice, "phase"), _needed(lattice, "group"))
        overview.add_row(*sizes, f"{lattice.courant:.4f}", f"{limit:.4f}", *needed)
    return overview


def _needed(lattice: Lattice, of: Speed) -> str:
    """Spacings per wavelength for 1 %, in words."""
    from dembound.exact.dispersion import cells_per_wavelength

    if not lattice.stable:
        return "unstable"
    return f"{cells_per_wavelength(lattice.horizon, lattice.courant, of=of, shares=lattice.shares):.1f}"


def _simulated(shown: Sequence[Lattice]) -> list[Points]:
    """Points computed by simulation, for stable lattices; prints how far they are from the formula."""
    import numpy as np

    from dembound.plot.dispersion import name
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

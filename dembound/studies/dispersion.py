"""Dispersion of bars of nodes: lattices from numbers or cases, their table, and simulations for comparison."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import tomli_w

from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step, even_lattices
from dembound.casefile import Case
from dembound.casefile.bar import SCHEMA, BarCase
from dembound.casefile.bar.bar import LARGEST, SMALLEST
from dembound.casefile.model import as_kind
from dembound.casefile.reader import loads
from dembound.errors import CaseError
from dembound.exact.bar import Lattice, usual_shares
from dembound.methods import Peridynamics
from dembound.methods.bonds import Bonds
from dembound.methods.method import WIDEST
from dembound.methods.rod import Rod
from dembound.motion.simulation import Simulation
from dembound.results.text_files import write_csv

COLUMNS = (
    *("horizon", "spacing", "time_step", "wave_speed", "shares"),
    *("wavenumber", "cells_per_wavelength", "frequency_hz", "phase_velocity", "group_velocity"),
)
"""Columns of the table; SI units, wave numbers in rad/m.

Shares that differ from those of L are separated by slashes, see `Lattice`.
"""

STEPS = 20
"""Number of steps simulated to measure a frequency: two are enough; more reduce rounding errors."""

ROWS = 100
"""Wave numbers of each lattice in the table, evenly up to its shortest wave."""


def lattices(
    horizons: Sequence[int], spacings: Sequence[float], time_steps: Sequence[float], wave_speed: float
) -> list[Lattice]:
    """Rows of nodes with all combinations of horizons, spacings (m) and time steps (s).

    Raises CaseError, as the options of the command line, for a number outside its range and if no lattice is stable.
    """
    limits = (
        ("horizon", horizons, 1, WIDEST, ""),
        ("spacing", spacings, SMALLEST, LARGEST, " m"),
        ("time-step", time_steps, 0.0, LARGEST, " s"),
        ("wave-speed", [wave_speed], SMALLEST**0.5, LARGEST**0.5, " m/s"),
    )
    problems = [
        f"--{option}: is {value:g}, must be {least:g} to {most:g}{unit}"
        for option, values, least, most, unit in limits
        for value in values
        if not least <= value <= most
    ]
    if problems:
        raise CaseError(problems)
    made = [Lattice(*numbers, wave_speed) for numbers in product(horizons, spacings, time_steps)]
    if not any(lattice.stable for lattice in made):
        limit = max(lattice.courant_limit * lattice.spacing / wave_speed for lattice in made)
        raise CaseError([f"--time-step: is {min(time_steps):g} s, must not be above the stability limit {limit:.6g} s"])
    return made


def lattices_of(case: Case) -> list[Lattice]:
    """The infinite rows of nodes for a case's bar, narrow horizons first; several if its method changes.

    Attenuation is left out. Raises CaseError for a case without a bar and a step above its stability limit.
    """
    bar = as_kind(case, BarCase, "is the case of disks, this command is for bars")
    scene = build_bar(bar)
    time_step, _ = choose_step(scene)
    stages = bar.method.stages(scene.rod)
    found = set(even_lattices(stages, scene.rod.ranges, time_step))
    return sorted(found, key=lambda lattice: (lattice.horizon, lattice.shares or ()))


def measure(lattice: Lattice, wavenumbers: np.ndarray) -> np.ndarray:
    """Angular frequencies (k,) rad/s of harmonic waves of some wave numbers (k,) rad/m in simulations.

    A bar is released from a displacement in the form of a cosine. The ends have no influence on the node in its middle
    during the simulation. Its displacements u and their second differences δ²u give sin²(ωΔt/2) = −¼ Σu δ²u/Σu²,
    without any formula for ω. The lattice must be stable and have a time step.
    """
    scene, middle, found = build_bar(_endless(lattice)), lattice.horizon * STEPS, []
    x = scene.positions[:, 0]
    for wavenumber in wavenumbers:
        simulation = Simulation(scene, lattice.time_step, [middle])
        simulation.state.u[0] = np.cos(wavenumber * (x - x[middle]))
        u = simulation.advance(STEPS)[:, 0, 0]
        square = -0.25 * np.sum(u[1:-1] * np.diff(u, 2)) / np.sum(u[1:-1] ** 2)
        sine = min(1.0, float(np.sqrt(square)))  # at the stability limit rounding may make it larger than 1
        found.append(2.0 * np.arcsin(sine) / lattice.time_step)
    return np.array(found)


class _Bonded(Peridynamics):
    """Peridynamics whose bonds carry given shares of the stress, see `Lattice`."""

    shares: tuple[float, ...]

    def begin(self, rod: Rod) -> Bonds:
        """All bonds."""
        influence = np.divide(self.shares, usual_shares(self.horizon))
        bonds = Bonds(rod, self.horizon, complement=False, influence=influence)
        bonds.add_zone(0, rod.count)
        return bonds


def _endless(lattice: Lattice) -> BarCase:
    """A bar so long that its ends do not affect its middle within STEPS steps."""
    length, step = 2 * lattice.horizon * STEPS * lattice.spacing, lattice.time_step
    bar = {"length": length, "spacing": lattice.spacing, "density": 1.0, "wave_speed": lattice.wave_speed}
    run = {"duration": STEPS * step, "time_step": step}
    text = tomli_w.dumps({"bar": bar, "method": {"type": "finite_difference"}, "run": run})
    case = as_kind(loads(text, (SCHEMA,), Path(), "endless"), BarCase, "is no bar")
    if lattice.horizon == 1:
        return case
    shares = lattice.shares or usual_shares(lattice.horizon)
    return replace(case, method=_Bonded(type="peridynamics", horizon=lattice.horizon, shares=shares))


def write_table(rows: Sequence[Lattice], path: Path) -> None:
    """Write frequencies and speeds of waves on some lattices as CSV, completely or not at all.

    Cells are empty where a wave grows.
    """
    write_csv(path, [COLUMNS, *(line for lattice in rows for line in _lines(lattice))])


def _lines(lattice: Lattice) -> Iterator[list[str]]:
    """The lines of one lattice."""
    wavenumber = lattice.shortest * np.arange(1, ROWS + 1) / ROWS
    hertz = lattice.frequency(wavenumber) / (2.0 * np.pi)
    speeds = lattice.phase_velocity(wavenumber), lattice.group_velocity(wavenumber)
    columns = wavenumber, 2.0 * lattice.shortest / wavenumber, hertz, *speeds
    same = [str(value) for value in (lattice.horizon, lattice.spacing, lattice.time_step, lattice.wave_speed)]
    same.append("/".join(f"{share:.10g}" for share in lattice.shares or ()))
    for numbers in zip(*columns, strict=True):
        yield same + ["" if np.isnan(number) else f"{number:.10g}" for number in numbers]

"""Deviation of the first spall from the closed form over many pulses, by method and spacing, as Markdown.

    python cases/lu2016/many_pulses.py RUN...

Each run's case meets 36 triangles: crests of 20 to 40 MPa after 0.02 to 0.08 ms. As nodes and steps are discrete, a
single pulse says little about a method; so does the difference between two methods for one pulse. The last column is
the time by which the bar breaks later than with FDM–PD3 of the same spacing, from the least to the most.
"""

import sys
from itertools import product
from pathlib import Path

import numpy as np

from dembound.bar.fracture import spalls
from dembound.casefile.bar import BarCase
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation
from dembound.papers.figure import markdown
from dembound.papers.spalled import MILLI, case_of, expected_spall, name_of
from dembound.running import plan

PRESSURES, RISES = np.linspace(20e6, 40e6, 9), (0.02e-3, 0.03e-3, 0.05e-3, 0.08e-3)
"""Crests in Pa and rises in s."""

HEADS = ("Δx (mm)", "method", "mean error of x (mm)", "most", "mean error of t (µs)", "most", "later by (µs)")

SHARE = 1.05
"""Simulated time in parts of that by the closed form."""


def spall(case: BarCase) -> np.ndarray:
    """Place (m) and time (s) of the first spall; nan where there is none in due time."""
    planned = plan(case)
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.run(round(SHARE * expected_spall(case)[1] / planned.time_step))
    found = spalls(simulation.system.parts[0].bonds, planned.scene.positions[:, 0], planned.time_step)
    return np.array([np.mean(found[0].start), found[0].time]) if found else np.full(2, np.nan)


def variants(case: BarCase) -> list[BarCase]:
    """The case under all pulses."""
    (load,) = case.load
    changes = [
        {"load": [load.model_dump() | {"pressure": float(pressure)}], f"wave.{load.wave}.rise": rise}
        for pressure, rise in product(PRESSURES, RISES)
    ]
    return [with_changes(case, change) for change in changes]


def main() -> None:
    """Print the table."""
    found, errors = {}, {}
    for case in [case_of(run) for run in map(Path, sys.argv[1:])]:
        key, under = (case.bar.spacing, name_of(case)), variants(case)
        found[key] = np.array([spall(each) for each in under])
        errors[key] = np.abs(found[key] - [expected_spall(each) for each in under])
    rows = []
    for (spacing, name), error in errors.items():
        later = 1e6 * (found[spacing, name] - found[spacing, "FDM–PD3"])[:, 1]
        mean, most = error.mean(axis=0), error.max(axis=0)
        place = f"{mean[0] / MILLI:.1f}", f"{most[0] / MILLI:.1f}"
        time = f"{1e6 * mean[1]:.2f}", f"{1e6 * most[1]:.2f}"
        rows.append((f"{spacing / MILLI:g}", name, *place, *time, f"{later.min():+.1f} to {later.max():+.1f}"))
    print(markdown(HEADS, rows))


if __name__ == "__main__":
    main()

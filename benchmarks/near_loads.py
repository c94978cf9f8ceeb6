"""The error of disks near a force in a lattice, compared with `errors_near_loads`.

    python benchmarks/near_loads.py

Monitors along a force that is spread over a region, in a body from whose sides nothing returns, which is run with its
own disks and with a third of their diameter; 9/8 of the difference is the error. RMS over RMS, of velocities; in
brackets by the formula.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
import tomli_w
from error_bound import FINER, far_motion
from scene_tables import ISOTROPIC, ROCK, SIDES, VISCOUS, lattice, monitors
from timing import small_option

from dembound.formulas.disks.near_disks import errors_near_loads
from dembound.formulas.history import History
from dembound.kinds import loads, with_changes
from dembound.running import plan

WIDE = 32.0
"""Width of the body, m; its disks are 1 m wide."""

DISTANCES = (4, 7, 10, 14)
"""Distances of monitors from the middle of the force, m."""

FREQUENCIES = (15.0, 25.0)
"""Frequencies of the Ricker wave, Hz."""

PERIODS = 2.6
"""Length of the runs, in periods."""

REGIONS = ((1.0, 1.0), (1.0, 4.0), (3.0, 3.0))
"""Half the width and height that the force is spread over, m; it acts along the width."""


def errors(material: dict[str, float], region: tuple[float, float], frequency: float) -> Iterator[tuple[float, float]]:
    """Errors at the distances, measured and by the formula."""
    middle, (x, y) = 0.5 * WIDE, region
    box = [middle - x, middle - y, middle + x, middle + y]
    tables = {
        "packing": lattice(WIDE, WIDE, 1.0),
        "material": material,
        "boundary": dict.fromkeys(SIDES, VISCOUS),
        "wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": frequency}},
        "load": [{"name": "push", "force": [1e6, 0.0], "region": box, "wave": "pulse"}],
        "monitor": monitors(**{f"r{r}": (middle + r + 0.5, middle + 0.5) for r in DISTANCES}),
        "run": {"duration": PERIODS / frequency},
    }
    case = loads(tomli_w.dumps(tables), name="near_loads")
    scene = plan(case).scene
    own, fine = (far_motion(with_changes(case, {"packing.radius": case.packing.radius / k})) for k in (1, FINER))
    for name, history in fine.items():
        late = own[name].at(history.time).velocity - history.velocity
        exact = history.velocity - late / (FINER**2 - 1)
        found = FINER**2 / (FINER**2 - 1) * float(np.linalg.norm(late[:, 0]) / np.linalg.norm(exact[:, 0]))
        seen = History(scene.monitored[name], history.time, {"velocity": exact[:, :2]})
        yield found, errors_near_loads(scene, seen)["velocity"]  # type: ignore[arg-type]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    small_option(parser)
    most = 1 if parser.parse_args().small else None
    print("| material | region | Ricker wave | " + " | ".join(f"{r} m" for r in DISTANCES) + " |")
    print("|---" * (len(DISTANCES) + 3) + "|")
    for name, material in (("without friction", ROCK), ("with friction", ISOTROPIC))[:most]:
        for region in REGIONS[:most]:
            for frequency in FREQUENCIES[:most]:
                both = " | ".join(f"{100 * a:.2f} ({100 * b:.2f}) %" for a, b in errors(material, region, frequency))
                wide = " × ".join(f"{2 * each:g}" for each in region)
                print(f"| {name} | {wide} m | {frequency:g} Hz | {both} |", flush=True)

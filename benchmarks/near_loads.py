"""The error of disks near a force in rock, beside the formula of `dembound run --error`.

    python benchmarks/near_loads.py

Monitors along a force in a body from whose sides nothing returns, which is run with its own disks and with a third of
their diameter; 9/8 of the difference is the error. RMS over RMS, of velocities.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import tomli_w
from error_bound import FINER, at_times, far_motion
from error_bound_scenes import embedded

from dembound.accuracy.history import History
from dembound.accuracy.of_disks.near import errors_near_loads
from dembound.kinds import loads, with_changes
from dembound.running import plan

WIDE = 40.0
"""Of the body, m; its disks are 1 m wide."""

DISTANCES = (4, 7, 10, 14)
"""From the middle of the force, m."""

FREQUENCIES = (6.0, 10.0, 20.0)
"""Of the Ricker wave, Hz."""

PERIODS = 3.2
"""Length of the runs, in periods."""


def errors(frequency: float) -> tuple[list[float], list[float]]:
    """Errors at the distances, measured and by the formula."""
    tables = embedded(WIDE, "ricker", (1e6, 0.0))
    middle = 0.5 * WIDE
    tables["wave"] = {"pulse": tables["wave"]["pulse"] | {"frequency": frequency}}
    tables["run"] = {"duration": PERIODS / frequency}
    tables["monitor"] = [{"name": f"r{r}", "position": [middle + r + 0.5, middle + 0.5]} for r in DISTANCES]
    case = loads(tomli_w.dumps(tables), name="near_loads")
    own, fine = (far_motion(with_changes(case, {"packing.radius": 0.5 / k})) for k in (1, FINER))
    measured = []
    for name, gauge in fine.items():
        late = at_times(own, name, "velocity", gauge.time) - gauge.velocity
        exact = gauge.velocity - late / (FINER**2 - 1)
        share = FINER**2 / (FINER**2 - 1)
        measured.append(share * float(np.linalg.norm(late[:, 0]) / np.linalg.norm(exact[:, 0])))
    scene = plan(case).scene
    formula = [
        errors_near_loads(scene, History(gauge.place, gauge.time, {"velocity": gauge.velocity[:, :2]}))["velocity"]  # type: ignore[arg-type]
        for gauge in (replace(each, position=scene.monitored[name]) for name, each in fine.items())
    ]
    return measured, formula


if __name__ == "__main__":
    print("| Ricker wave | " + " | ".join(f"{r} m" for r in DISTANCES) + " |")
    print("|---" * (len(DISTANCES) + 1) + "|")
    for frequency in FREQUENCIES:
        both = zip(*errors(frequency), strict=True)
        print(
            f"| {frequency:g} Hz | " + " | ".join(f"{100 * a:.2f} ({100 * b:.2f}) %" for a, b in both) + " |",
            flush=True,
        )

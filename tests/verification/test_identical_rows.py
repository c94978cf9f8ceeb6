"""A run in which one of several identical rows is stepped gives the same record as one in which all are stepped."""

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from dembound.kinds import with_changes
from dembound.running import run_case

INPUT_P = {"type": "viscous_input", "wave_p": "pulse"}
INPUT = {**INPUT_P, "wave_s": "pulse"}
MOVED = {"type": "velocity", "wave_p": "pulse"}
WEIGHTLESS = {"type": "viscous", "beta_p": 0.0, "beta_s": 0.0, "half_mass": True}
"""A side of half cells on which no force acts."""

PERIODIC = {"left": INPUT, "right": "viscous", "bottom": "periodic", "top": "periodic"}
HALF_CELLS = {"bottom": WEIGHTLESS, "top": WEIGHTLESS}
LOADS = [{"region": [0.0, 0.0, 0.4, 4.0], "force": [5e6, 0.0], "wave": "pulse"}, {"acceleration": [9.81, 0.0]}]
UPRIGHT = {"size": (4.0, 20.0), "held": ("x",)}
CASES = {
    "P wave between free sides that could move": ({"boundary": {"left": MOVED, "right": "viscous"}, "held": ()}, 8),
    "upright": ({"boundary": {"bottom": MOVED, "top": "viscous"}} | UPRIGHT, 8),
    "P and S, half cells at the end": (
        {"boundary": PERIODIC | {"right": {"type": "viscous", "half_mass": True}}, "held": ()},
        8,
    ),
    "random": ({"pattern": "B", "size": (20.0, 30.0), "boundary": PERIODIC, "held": ()}, 3),
    # the outer rows have half the mass and half the contacts, of two rows both
    "half cells along the bar": ({"boundary": {"left": MOVED, "right": "free"} | HALF_CELLS}, 8),
    "two rows of half cells": (
        {"boundary": {"left": INPUT_P, "right": "viscous"} | HALF_CELLS, "size": (20.0, 1.0)},
        2,
    ),
    "springs": (
        {
            "boundary": {
                "left": {**INPUT_P, "type": "viscoelastic_input", "distance": 30.0},
                "right": {"type": "viscoelastic", "distance": 30.0},
            }
        },
        8,
    ),
    "damping": ({"boundary": PERIODIC, "held": (), "material": {"damp": 0.3}}, 8),
    "layers": (UPRIGHT | {"boundary": {"left": "periodic", "right": "periodic", "bottom": INPUT}, "held": ()}, 8),
    "loads on all rows": ({"boundary": {"left": "free", "right": "viscous"}, "load": LOADS}, 8),
}
LAYERS = [{"thickness": 2.0, "density": 1800.0, "s_wave_speed": 200.0}, {"s_wave_speed": 400.0}]
TO_THE_BIT = ("P wave between free sides that could move", "upright")
"""Cases in which histories of monitors, fields and peaks are the same to the last bit."""


def record_of(case, folder: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """All datasets of the record of a case by name, and its summary."""
    done = run_case(case, folder)
    names: list[str] = []
    with h5py.File(done / "run.h5") as file:
        file.visit(names.append)
        data = {name: file[name][()] for name in names if isinstance(file[name], h5py.Dataset)}
    return data, json.loads((done / "summary.json").read_text())


LATE = ("half cells along the bar", "springs", "damping")
"""Cases with ``-m slow``: two rows of half cells, other dashpots and layers do as much with the bookkeeping of rows."""


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in LATE else n for n in CASES])
def test_the_record_is_the_same(lab, tmp_path, name):
    words, rows = CASES[name]
    words = {"pattern": "A", "size": (20.0, 4.0)} | words
    case = lab.case(wave=lab.pulse(0.02), duration=0.05, **words)
    monitors = [{"name": f"m{k}", "position": [0.3 * k * side for side in words["size"]]} for k in range(4)]
    layers = {"layer": LAYERS} if name == "layers" else {}
    fields = {"snapshots": 2, "peaks": True, "stress": True, "contacts": True}
    output = {"pictures": False, "energy_interval": 4e-3} | fields
    case = with_changes(case, {"monitor": monitors, "output": output} | layers)
    data, summary = record_of(case, tmp_path / "with")
    expected, of_all = record_of(with_changes(case, {"reduce.rows": False}), tmp_path / "without")
    particles = summary["particles"]
    saved = f"{particles // rows:,} of {particles:,} disks"
    assert summary["reduced"] == [f"rows: {rows} identical rows are stepped as one, {saved}"]
    assert (summary["time_step"], particles) == (of_all["time_step"], of_all["particles"])
    assert set(data) == set(expected)

    def largest(end: str) -> float:
        return max(np.abs(values).max(initial=0.0) for name, values in expected.items() if name.endswith(end))

    # sums in another order differ by the rounding of displacements, a few ε·u/Δt of velocity per step; local damping
    # jumps where a velocity changes its sign, which rounding may move by a step
    jitter = 8.0 * np.finfo(float).eps * largest("displacement") / of_all["time_step"] * of_all["steps"]
    relative, of_energy = (1e-7, 1e-7) if name == "damping" else (jitter / largest("velocity"), 1e-12)
    assert largest("velocity") > 0.1  # the pulse did run
    assert relative < 1e-6
    for path, values in expected.items():
        group, quantity = path.split("/")[0], path.split("/")[-1]
        sums = group == "boundaries" and quantity in ("force", "displacement")  # over a side, in another order
        exact = name in TO_THE_BIT and group in ("histories", "snapshots", "boundaries") and not sums
        if values.dtype.kind != "f" or exact:
            np.testing.assert_array_equal(data[path], values, err_msg=path)
            continue
        like = "_force" if quantity.endswith("_force") else quantity.removeprefix("peak_")
        bound = of_energy * largest("energy/kinetic") if group == "energy" else relative * largest(like)
        np.testing.assert_allclose(data[path], values, rtol=0.0, atol=bound, err_msg=path)

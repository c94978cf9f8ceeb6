"""What the scripts beside this file read from the results of `dembound run`, and how they show it."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from dembound.bar import build_bar
from dembound.case import BarCase, loads
from dembound.methods.bonds import Bonds

MILLI, MEGA = 1e-3, 1e6


def summary_of(run: Path) -> dict[str, Any]:
    """A run's summary."""
    return json.loads((run / "summary.json").read_text())


def first_spall(run: Path) -> dict[str, Any]:
    """Its first spall: `time` (s) and `start`, the range of its cracked nodes (m)."""
    return summary_of(run)["spalls"][0]


def case_of(run: Path) -> BarCase:
    """The case that was run."""
    with h5py.File(run / "run.h5") as file:
        case = loads(file.attrs["case"], name=file.attrs["name"])
    assert isinstance(case, BarCase)
    return case


def history(run: Path, monitor: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Times (k,) s and stresses (k,) Pa at a monitor, and where it stands, m."""
    with h5py.File(run / "run.h5") as file:
        group = file[f"histories/{monitor}"]
        return group["time"][:], group["stress"][:], float(group.attrs["position"][0])


def stress_along(run: Path, time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Places (n,) m and stresses (n,) Pa at the snapshot nearest to a time, and its own time, s."""
    with h5py.File(run / "run.h5") as file:
        nearest = min(file["snapshots"].values(), key=lambda group: abs(group.attrs["time"] - time))
        return file["particles/position"][:, 0], nearest["stress"][:], float(nearest.attrs["time"])


def damage_along(run: Path, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Places (n,) m and local damage (n,) at any time in s, from the bonds that had broken by then (L eq. 7)."""
    case = case_of(run)
    scene = build_bar(case)
    with h5py.File(run / "run.h5") as file:
        first, second = file["cracks/particles"][file["cracks/time"][:] <= time].T
    if case.method.type == "finite_difference":
        bonds = Bonds(scene.rod, 0)
        bonds.spring_broken[first] = 0
    else:
        bonds = Bonds(scene.rod, case.method.largest_horizon)
        bonds.bond_broken[second - first - 1, first] = 0
        bonds.cover(0, scene.rod.count)
    return scene.positions[:, 0], bonds.damage()


def expected_spall(case: BarCase) -> tuple[float, float]:
    """Place (m) and time (s) of the first spall by the closed form, d = ½c t_d σ_t/p_m and t_r + (L + d)/c."""
    (load,), bar = case.load, case.bar
    pulse = case.wave[load.wave]
    distance = 0.5 * bar.speed * pulse.fall * bar.modulus * bar.breaking_stretch / load.pressure
    return bar.length - distance, pulse.rise + (bar.length + distance) / bar.speed


def name_of(case: BarCase) -> str:
    """The method as L calls it."""
    method, m = case.method, case.method.largest_horizon
    before = "PD1" if getattr(method, "before", "") == "peridynamics" else "FDM"
    return {
        "finite_difference": "FDM",
        "peridynamics": f"PD{m}",
        "switch": f"{before}–PD{m}",
        "patch": f"FDM with patches of PD{m}",
    }[method.type]


def in_millimetres(range_of: Sequence[float]) -> str:
    """A range in m as "906–909"."""
    return "–".join(f"{place / MILLI:.4g}" for place in range_of)


def markdown(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)

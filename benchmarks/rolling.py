"""Angles at which loose disks shear and stand, by friction and rolling resistance, and how still piles are.

    python benchmarks/rolling.py [shear] [piles] [--seeds 1 2]

`shear`: disks between a fixed base and a platen under a pressure, periodic sideways, which shears them at an inertial
number of 0.005; angle of the mean traction on the base from a shear of 0.7 on. `piles`: a column on a rough floor,
whose side wall draws back slowly; angle of the slope, kinetic energy at the end over the drop of potential energy, and
the largest error of the ledger over this drop. docs/tasks/cracks.md has what was found.
"""

import argparse
import itertools
import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from timing import small_option

import dembound

ROLLING: tuple[float | None, ...] = (0.0, 0.4, 1.0, 1.5, None)
"""Values of rr_fric; None: rotation is held."""

LOOSE = {"density": 2000.0, "law": "linearpbond", "emod": 2e7, "pb_emod": 0.0, "kratio": 2.0, "fric": 0.5}
RADIUS, PRESSURE, GRAVITY = 0.1, 1e5, 9.81


def tables(rolling: float | None, size: tuple[float, float], seed: int) -> dict[str, Any]:
    """Loose disks in one brick of a size (m)."""
    return {
        "packing": {"pattern": "B", "size": size, "brick": size, "radius": RADIUS, "radius_ratio": 1.5, "seed": seed},
        "material": LOOSE | {"rr_fric": rolling or 0.0, "dp_nratio": 0.2},
        "motion": {"held": ["rotation"] if rolling is None else []},
        "output": {"pictures": False},
    }


def run(case: dict[str, Any], folder: str) -> dembound.Results:
    """The results of a case, in a folder."""
    path = Path(folder, "case.toml")
    path.write_text(tomli_w.dumps(case))
    return dembound.run(path, Path(folder, "results"))


def shear_angle(rolling: float | None, seed: int, folder: str) -> tuple[float]:
    """Angle (degrees) of the mean traction of 20 × 20 disks in steady shear."""
    sides = {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": {"type": "fixed"}}
    found = run(
        tables(rolling, (4.0, 4.0), seed)
        | {
            "boundary": sides | {"top": {"type": "velocity", "hold": ["shear"], "wave_s": "shear"}},
            "static": {"ratio": 1e-4, "boundary": {"bottom": {"type": "fixed"}}},
            "load": [{"name": "cell", "pressure": PRESSURE, "sides": ["top"]}],
            "wave": {"shear": {"type": "constant", "amplitude": 0.7, "rise": 0.2}},
            "run": {"duration": 12.0},
        },
        folder,
    )
    base = found.boundaries["bottom"]
    shear, push = base["force"][base["time"] > 4.0].mean(axis=0)
    return (math.degrees(math.atan(abs(shear / push))),)


def pile(rolling: float | None, seed: int, folder: str) -> tuple[float, float, float]:
    """Angle (degrees) of a slope of 450 disks, kinetic energy and largest error of the ledger over the drop."""
    teeth = [[0.2 * k - 0.2, -0.1 * (k % 2) - 0.15] for k in range(60)]
    walls: list[dict[str, Any]] = [
        {"name": "floor", "points": teeth, "fric": 0.5, "rr_fric": rolling or 0.0, "dp_nratio": 0.2},
        {"name": "back", "points": [[-0.12, -0.4], [-0.12, 5.0]]},
        {"name": "gate", "points": [[4.62, -0.4], [4.62, 5.0]], "velocity": [0.4, 0.0], "until": 8.0},
    ]
    found = run(
        tables(rolling, (4.5, 3.0), seed)
        | {
            "wall": walls,
            "load": [{"name": "weight", "acceleration": [0.0, -GRAVITY]}],
            "static": {"ratio": 1e-4},
            "run": {"duration": 12.0},
        },
        folder,
    )
    energy, last = found.energy, found.snapshots[-1]
    place = found.particles["position"] + last["displacement"][:, :2]
    drop = float(np.abs(energy["load"]).max())
    return slope_of(place), float(energy["kinetic"][-1]) / drop, float(np.abs(energy["error"]).max()) / drop


def slope_of(place: np.ndarray) -> float:
    """Angle (degrees) of the line through the highest disks of bands a diameter wide, without the ends of the slope."""
    band = np.floor(place[:, 0] / (2.0 * RADIUS)).astype(int)
    top = np.array([(place[band == k, 0].mean(), place[band == k, 1].max()) for k in np.unique(band)])
    high = top[:, 1].max()
    middle = top[(top[:, 1] > 0.15 * high) & (top[:, 1] < 0.85 * high)]
    return math.degrees(math.atan(-np.polyfit(middle[:, 0], middle[:, 1], 1)[0]))


def main() -> None:
    """Print a table of each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", default=["shear", "piles"])
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2])
    small_option(parser, parts=["shear"], seeds=[1])
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for part, rolling in itertools.product(asked.parts, ROLLING):
            name = "locked" if rolling is None else f"rr_fric {rolling:g}"
            rows = [(shear_angle if part == "shear" else pile)(rolling, seed, folder) for seed in asked.seeds]
            print(f"{part} {name}:", "; ".join(" ".join(f"{value:.3g}" for value in row) for row in rows), flush=True)


if __name__ == "__main__":
    main()

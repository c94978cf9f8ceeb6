"""Speed of packing bricks, and the time of its parts.

    python benchmarks/pack_rate.py [--sides 10 50] [--repeats 5]

Packs square bricks of pattern B with radii from 0.2 to 0.3 m, without the cache, compiled first. CPU seconds are taken,
as packing uses one core; medians are quoted. "relax" are the steps, "lists" the lists of near pairs before them. The
digest of the positions is the same if two versions pack the same brick to the last bit.
"""

import argparse
import hashlib
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from timing import show, small_option

from dembound.kernels import pack
from dembound.packings import bed
from dembound.packings.brick import Brick
from dembound.packings.dense import Recipe, pack_dense

spent: dict[str, float] = {}
counted: dict[str, int] = {}


def timed(name: str, work: Callable[..., Any]) -> Callable[..., Any]:
    """The function `work`, with its CPU seconds and calls added up under a name."""

    def call(*args: Any) -> Any:
        began = time.process_time()
        result = work(*args)
        spent[name] = spent.get(name, 0.0) + time.process_time() - began
        counted[name] = counted.get(name, 0) + 1
        if name == "relax":
            counted["steps"] = counted.get("steps", 0) + result[1]
        return result

    return call


def packed(side: float) -> Brick:
    return pack_dense(Recipe((side, side), radius=0.25, radius_ratio=1.5, pressure=8e-3, bond_gap=0.0, seed=1))


COLUMNS = {
    "disks": "{disks:,}",
    "steps": "{steps:,}",
    "lists": "{lists}",
    "CPU s": "{cpu:.3f}",
    "steps: s": "{relax:.3f}",
    "lists: s": "{listing:.3f}",
    "ns per disk and step": "{each:.1f}",
    "positions": "{digest}",
}


def measure(side: float, repeats: int) -> dict[str, Any]:
    runs = []
    for _ in range(repeats):
        spent.clear()
        counted.clear()
        began = time.process_time()
        brick = packed(side)
        runs.append((time.process_time() - began, spent["relax"], spent["lists"]))
    cpu, relax, listing = (float(value) for value in np.median(runs, axis=0))
    disks, steps = len(brick.radii), counted["steps"]
    return {
        "disks": disks,
        "steps": steps,
        "lists": counted["lists"],
        "cpu": cpu,
        "relax": relax,
        "listing": listing,
        "each": relax / steps / disks * 1e9,
        "digest": hashlib.sha256(np.ascontiguousarray(brick.positions).tobytes()).hexdigest()[:12],
    }


def measured(sides: Sequence[float], repeats: int) -> list[dict[str, Any]]:
    """Rows of `COLUMNS` for bricks of these sides (m), which are also printed."""
    packed(5.0)  # compiles
    pack.relax, bed.listed = timed("relax", pack.relax), timed("lists", bed.listed)
    rows = [measure(side, repeats) for side in sides]
    show("Packing", COLUMNS, rows)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sides", type=float, nargs="+", default=[10.0, 50.0], help="of the bricks (m)")
    parser.add_argument("--repeats", type=int, default=5)
    small_option(parser, sides=[10.0], repeats=1)
    options = parser.parse_args()
    measured(options.sides, options.repeats)


if __name__ == "__main__":
    main()

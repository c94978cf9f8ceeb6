"""Delay of waves that enter disks relative to waves through the plane of a side, compared with `entries_of`.

    python benchmarks/entries.py [--packings A ...]

Columns 160 m high of disks of 1 m, periodic sideways, under a wave 100 disks long from below. The delay of the motion
follows from the best fit of v(t − (y + late)/c) to 400 disks at 20 to 100 m. The bias of the fit by scatter of the
packing is the same however waves enter, so it is removed with a run in which they enter through a continuum, whose
delay is known.
"""

import argparse
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import tomli_w
from scene_tables import ISOTROPIC, Tables, grains, lattice, pulse
from timing import show, small_option

HEIGHT, WIDE, DISKS = 160.0, 20.0, 400
KINDS: dict[str, Tables] = {
    "continuum": {"type": "outside"},
    "velocity": {"type": "velocity"},
    "dashpots": {"type": "viscous_input"},
    "half cells": {"type": "viscous_input", "half_mass": True},
    "springs": {"type": "viscoelastic_input", "distance": 1e5},
    "free field": {"type": "viscous_input"},
}


def column(packing: Tables, motion: str, kind: str) -> Tables:
    """A column under a wave."""
    speed, period = (1000.0, 0.1) if motion == "p" else (700.0, 0.14)
    beside = {"type": "free_field" if kind == "free field" else "periodic"}
    across = np.random.default_rng(1).uniform(0.3, WIDE - 0.3, DISKS)
    up = np.linspace(20.0, 100.0, DISKS)
    return {
        "packing": packing,
        "material": ISOTROPIC,
        "boundary": {"left": beside, "right": beside, "bottom": KINDS[kind] | {f"wave_{motion}": "pulse"}},
        "wave": pulse(period),
        "monitor": [
            {"name": f"m{k}", "position": [float(x), float(y)]} for k, (x, y) in enumerate(zip(across, up, strict=True))
        ],
        "run": {"duration": period + 100.0 / speed},
    }


def measured(tables: Tables, motion: str) -> tuple[float, float]:
    """Distance (m) by which the motion is late, measured and by formula."""
    from scipy.optimize import minimize_scalar

    from dembound.accuracy.runner import measure
    from dembound.disks.scene import build
    from dembound.formulas.disks.entry import entries_of
    from dembound.kinds import loads
    from dembound.running import Progress

    case: Any = loads(tomli_w.dumps(tables), name="entry")
    entry = entries_of(build(case))["bottom"][motion]  # type: ignore[index]
    own = list(measure(case, Progress())[0].motions.values())
    wave, column = case.wave["pulse"], 1 if motion == "p" else 0

    def rest(late: float) -> float:
        each = (h.velocity[:, column] - wave.velocity(h.time - (h.place[1] + late) / entry.speed) for h in own)
        return float(sum(np.sum(values**2) for values in each))

    found = minimize_scalar(rest, bounds=(-2.0, 2.0), method="bounded", options={"xatol": 1e-4})
    return float(found.x), entry.late


def rows(chosen: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Rows of the table."""
    packings = {"A": lattice(WIDE, HEIGHT, 1.0)}
    packings |= {f"{p}, seed {k}": grains(WIDE, HEIGHT, 1.0, WIDE, k, p) for p in "BC" for k in (1, 2)}
    for name, packing in packings.items():
        if not name.startswith(tuple(chosen)):
            continue
        for motion in "ps":
            off = 0.0
            for kind in KINDS:
                if kind == "half cells" and name.startswith("B"):
                    continue
                late, formula = measured(column(packing, motion, kind), motion)
                if kind == "continuum":
                    off = late - formula
                yield {"packing": name, "wave": motion, "side": kind, "late": late - off, "formula": formula}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packings", nargs="+", choices=list("ABC"), default=list("ABC"))
    small_option(parser, packings=["A"])
    options = parser.parse_args()
    columns = {key: f"{{{key}}}" for key in ("packing", "wave", "side")}
    show("later, D", columns | {"measured": "{late:.3f}", "formula": "{formula:.3f}"}, rows(options.packings))

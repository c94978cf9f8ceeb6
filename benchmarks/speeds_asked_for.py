"""Phase speeds of P and S waves in a random packing that is asked for them, from runs.

Two monitors, the same disk of two bricks, are a whole number of bricks apart: between them each frequency turns by ωL/c
whatever the disks around do. c(ω) = c₀(1 − aω²) is fitted to the frequencies of the pulse; printed is c₀ over the speed
asked for, along x.

    python benchmarks/speeds_asked_for.py [SEED]
"""

import argparse
import tempfile

import numpy as np
from timing import small_option

from dembound import api

BRICK, APART, BRICKS = 20.0, 8, 24
ASKED = {"p_wave_speed": 5000.0, "s_wave_speed": 2900.0}
PERIODS = 3.0
"""Brick sides in the shortest wavelength of the pulse."""


def tables(kind: str, seed: int) -> dict:
    """A strip of bricks, periodic across, that one wave runs through."""
    speed = ASKED[f"{kind}_wave_speed"]
    return {
        "packing": {
            **{"pattern": "B", "radius": 0.5, "radius_ratio": 1.66, "brick": [BRICK, BRICK], "seed": seed},
            "bricks": [BRICKS, 1],
        },
        "material": {"density": 2630.0, "fric": 0.5, "along": "x", **ASKED},
        "boundary": {
            **{side: {"type": "periodic"} for side in ("bottom", "top")},
            "left": {"type": "viscous_input", f"wave_{kind}": "w", "beta_p": "matched", "beta_s": "matched"},
            "right": {"type": "viscous", "beta_p": "matched", "beta_s": "matched"},
        },
        "wave": {"w": {"type": "cosine", "amplitude": 0.1, "period": 2.0 * PERIODS * BRICK / speed}},
        "monitor": [{"name": f"m{k}", "position": [(k + 0.5) * BRICK, 0.5 * BRICK]} for k in (4, 4 + APART)],
        "run": {"duration": BRICKS * BRICK / speed + 4.0 * PERIODS * BRICK / speed},
        "output": {"pictures": False},
    }


def measured(kind: str, seed: int) -> float:
    """Speed of long waves over that asked for."""
    with tempfile.TemporaryDirectory() as folder:
        results = api.run(api.case("strip", **tables(kind, seed)), folder)
        histories = [results.histories[f"m{k}"] for k in (4, 4 + APART)]
        moved, time = [each["velocity"][:, "ps".index(kind)] for each in histories], histories[0]["time"]
    speed = ASKED[f"{kind}_wave_speed"]
    omega = 2.0 * np.pi * np.linspace(0.2, 1.0, 9) * speed / (2.0 * PERIODS * BRICK)
    one, other = (np.exp(-1j * np.outer(omega, time)) @ each for each in moved)
    turn = -np.angle(other / one * np.exp(1j * omega * APART * BRICK / speed))
    found = speed / (1.0 + turn * speed / (omega * APART * BRICK))
    return float(np.polyfit(omega**2, found, 1)[1]) / speed


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seed", nargs="?", type=int, default=0)
    small_option(parser)
    options = parser.parse_args()
    for kind in "p" if options.small else "ps":
        print(f"c_{kind}: {100.0 * (measured(kind, options.seed) - 1.0):+.4f} % of the speed asked for")

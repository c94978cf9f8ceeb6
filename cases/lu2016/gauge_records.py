"""Synthetic records of a spalling test: weak.txt and strong.txt, two columns of time (s) and stress (Pa).

    python cases/lu2016/gauge_records.py [FOLDER]      (default: the current one)

c = 2740 m/s, α = 0.52 1/m, noise of 1 % of the largest tension (weak) or of the crest (strong). What `dembound gauge`
estimates from them stands in docs/evidence/spalling_test.md.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from dembound.waves import Triangle

LENGTH, GAUGE, SPEED, ATTENUATION = 0.99, 0.6, 2740.0, 0.52
"""Of the bar, m; place of the gauge, m; m/s; 1/m."""

CREST = 34.9e6
"""Of the strong pulse, Pa."""


def measured(time: np.ndarray, pulse: Triangle, ways: Sequence[float], signs: Sequence[int]) -> np.ndarray:
    """Stress (Pa) of a pulse's passages, each after a way (m) from the loaded end; amplitudes: at the gauge."""
    shares = np.exp(-ATTENUATION * (np.array(ways) - GAUGE))
    passages = zip(signs, shares, ways, strict=True)
    return sum(sign * share * pulse.velocity(time - way / SPEED) for sign, share, way in passages)


if __name__ == "__main__":
    folder = Path(sys.argv[1] if sys.argv[1:] else ".")
    time = 1e-6 * np.arange(5000)
    noise = 0.01 * np.random.default_rng(1).standard_normal(len(time))

    weak = Triangle(type="triangle", amplitude=1e6, start=20e-6, rise=40e-6, fall=80e-6)
    to_and_fro = [2 * turn * LENGTH + way for turn in range(6) for way in (GAUGE, 2 * LENGTH - GAUGE)]
    stress = measured(time, weak, to_and_fro, [-1, 1] * 6)
    np.savetxt(folder / "weak.txt", np.column_stack([time, stress + stress.max() * noise]))

    strong = Triangle(type="triangle", amplitude=CREST, start=20e-6, rise=40e-6, fall=200e-6)
    stress = measured(time, strong, [GAUGE], [-1])
    np.savetxt(folder / "strong.txt", np.column_stack([time, stress + CREST * noise])[:520])

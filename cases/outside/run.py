"""Measures and draws what docs/evidence (outside.md, where_methods_fail.md) quotes of continua beyond sides.

    python cases/outside/run.py [RESULTS]      (default: results/outside)

It takes some five minutes. The pictures are RESULTS/*.png.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "where_methods_fail"))

import numpy as np
from angles import DIAMETER, FREQUENCY, Side, branches, reflection
from decay import disks_and_grid, grid_alone, kinetic, step_beside
from drawings import DASHPOTS, PICTURES
from lasting import SPEED, TYPES, exact_settlement, half_space, inner, settlement
from oblique import reflection as of_dashpots
from report import report

BOXES = {"whole": None, "notch in the surface": (5, 4, 7, 6), "hole": (5, 4, 7, 5)}
"""Names of boxes of elements left out."""


def amplitudes(found: dict[str, float]) -> str:
    """Both amplitudes in per cent."""
    return ", ".join(f"{kind.upper()} {100.0 * found[kind]:.2g}" for kind in "ps")


def of_angles() -> Iterator[str]:
    """Reflection against the angle, then at normal incidence with coarser elements and fewer layers."""
    side = Side.of()
    for motion in "ps":
        speed = side.speeds["ps".index(motion)]
        for angle in (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 80.0):
            beyond = amplitudes(reflection(side, motion, angle))
            dashpots = amplitudes(of_dashpots(DASHPOTS, motion, angle, speed / FREQUENCY / DIAMETER))
            formula = 100.0 * side.formula(motion, angle)
            yield f"{motion.upper()} {angle:g}°: continuum {beyond} %; dashpots {dashpots} %; formula {formula:.2g} %"
    for nodes in (17.0, 10.0, 8.0, 6.0, 5.0, 4.0):
        for layers in (2, 3, 4):
            coarse = Side.of(nodes, layers)
            found = ", ".join(f"{m.upper()} {100.0 * reflection(coarse, m, 0.0)[m]:.2g}" for m in "ps")
            yield f"{nodes:g} nodes in the S wave, {layers} layers: at normal incidence {found} %"
    for keys in ({"reflection": 1e-6}, {"reflection": 1e-6, "layers": 5}, {"order": 3}, {"order": 6}):
        other = Side.of(**keys)
        found = ", ".join(f"{m.upper()} {100.0 * reflection(other, m, 75.0)[m]:.2g}" for m in "ps")
        yield f"{keys}: at 75° {found} %"


def of_loads_that_stay() -> Iterator[str]:
    """Relative differences from the exact settlement."""
    times = np.array([1.0, 5.0, 10.0, 20.0])
    expected = exact_settlement(half_space(), times)
    yield f"exact at {times} s: {1e3 * expected} mm"
    for side in TYPES:
        yield f"{side}: {100.0 * (settlement(half_space(side), times) / expected - 1.0)} %"
    for keys in (*({"margin": margin} for margin in (2, 3, 6, 12)), {"layers": 2}, {"reflection": 1e-6}):
        case = half_space(**keys)
        found = 100.0 * (settlement(case, times) / expected - 1.0)
        yield f"{keys}, c_p t/L up to {SPEED * times[-1] / inner(case):.0f}: {found} %"


def of_noise() -> Iterator[str]:
    """Kinetic energies over the initial energy of the noise."""
    steps = [1_000, 10_000, 50_000, 100_000, 150_000, 200_000]
    runs = {f"{pattern}, fric {fric:g}": (pattern, fric) for pattern in "AB" for fric in (0.5, 0.0)}
    for name, (pattern, fric) in runs.items():
        yield f"disks {name}: {kinetic(disks_and_grid(pattern, fric), steps)}"
    for ratio in (0.0, 0.25, 0.4):
        for name, box in BOXES.items():
            yield f"grid, Poisson's ratio {ratio:g}, {name}: {kinetic(grid_alone(ratio, box=box), steps)}"
    for order in (3, 5, 6):
        yield f"grid, order {order}: {kinetic(grid_alone(order=order), steps)}"
    yield f"grid without the delay, at 1,000, 10,000 and 40,000: {kinetic(grid_alone(delay=0.0), [1000, 10000, 40000])}"
    for pattern in "AB":
        first = step_beside(3.0, pattern)
        shares = ", ".join(f"{step_beside(spacing, pattern) / first:.3f}" for spacing in (2.0, 1.25, 1.0, 0.75))
        yield f"pattern {pattern}: step at 2, 1.25, 1, 0.75 D between nodes over that at 3 D: {shares}"
    yield f"frequencies of rotations at λ = ∞ and 2 D: {branches(0.0)[2]:.3f}, {branches(np.pi)[2]:.3f} c_p/D"


if __name__ == "__main__":
    np.set_printoptions(precision=3, linewidth=200)
    report((of_angles(), of_loads_that_stay(), of_noise()), PICTURES, "results/outside")

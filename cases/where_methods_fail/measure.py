"""Measures the thresholds of docs/where_methods_fail.md, prints a line for each, and draws the pictures.

    python cases/where_methods_fail/measure.py [RESULTS]      (default: results/where_methods_fail)

It takes about a minute. The pictures are RESULTS/*.png.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import bars
import grains
import sides
from oblique import reflection
from pictures import PICTURES

from dembound.plot.style import save

Row = tuple[str, Callable[[], str]]
"""What is measured, and the measurement in words."""


def of_sides() -> Iterator[Row]:
    """Dashpots, springs, columns."""
    yield "lagged dampers", lambda: f"β = 2, half end mass: {sides.lagged_limit(2.0):.3f} of the limit"
    for beta in (1.04, 2.0, 1e4):
        yield f"β = {beta:g}", lambda beta=beta: "reflects {:.4f}; noise at 0.9995 of the limit grows: {}".format(
            *sides.strong_dashpot(beta)
        )
    for names in (("left",), ("left", "bottom")):
        yield f"springs at {' and '.join(names)}", lambda names=names: (
            f"step 1 % lower from L = {sides.reach_of_springs(0.01, names) / sides.DIAMETER:.4f} D on, half from "
            f"{sides.reach_of_springs(0.5, names) / sides.DIAMETER:.4f} D on"
        )
    yield "drift", lambda: "{:.6g} m/s, F/ΣC = {:.6g} m/s".format(*sides.drift())
    for ratio in (1.0, 10.0, 100.0):
        yield f"springs, λ/L = {ratio:g}", lambda ratio=ratio: "reflect {:.4f}, formula {:.4f}".format(
            *sides.on_springs(ratio)
        )
    for motion in "ps":
        for angle in (0.0, 30.0, 60.0, 75.0, 85.0):
            yield f"{motion.upper()} at {angle:g}°", lambda motion=motion, angle=angle: ", ".join(
                f"{name} {value:.4f}"
                for name, value in reflection({"type": "viscous", "half_mass": True}, motion, angle).items()
            )
    for count in (20.0, 100.0, 500.0):
        yield f"foot of a column, {count:g} disks in a wavelength", lambda count=count: (
            f"whole cells return {sides.foot(False, count):.2e}, half cells {sides.foot(True, count):.2e}"
        )
    for height in (10.0, 20.0, 40.0):
        yield f"bar {height:g} m high", lambda height=height: f"β off by {100.0 * sides.narrow(height):.2f} %"
    yield "bar periodic sideways", lambda: f"β off by {100.0 * sides.narrow(10.0, free=False):.3f} %"


def of_grains() -> Iterator[Row]:
    """Packings and contact laws."""
    for pattern in "ABC":
        for count in (10.0, 20.0, 40.0):
            yield f"pattern {pattern}, {count:g} diameters in a wavelength", lambda pattern=pattern, count=count: (
                "late by {:.4f}, peak lower by {:.4f}".format(*grains.pulse_along_bar(pattern, count))
            )
    for length in (16.0, 20.0, 28.0, 40.0):
        yield f"coda, wavelength {length:g} m", lambda length=length: (
            f"bricks of 10 m {grains.coda(length):.4f}, of 5 m {grains.coda(length, 5.0):.4f}"
        )
    yield "no tension", lambda: "a pull runs at {:.4f} c, a push at {:.4f} c".format(*grains.speed_of_tension())
    yield "locked-in stress", lambda: "largest tension of a bond over the pressure: " + ", ".join(
        f"{grains.locked_in_tension(seed):.2f}" for seed in (1, 2, 3)
    )
    for ratio in (1.0, 0.5, 0.25):
        yield f"pb_rmul = {ratio:g}", lambda ratio=ratio: f"breaks at {grains.thin_bond(ratio):.3f} pb_ten"
    for angle in (0.001, 0.01, 0.1):
        yield f"rotation by {angle:g}", lambda angle=angle: f"stress {grains.stress_of_rotation(angle):.2e} ρc²"
    yield "elastic start", lambda: f"left at a rotation of {grains.end_of_elastic_start():.4f}"
    yield "contacts that open", lambda: "stable to {:.4f} of the linear limit, used up to {:.4f}".format(
        *grains.opening_limit()
    )


def of_bars() -> Iterator[Row]:
    """Bars of nodes."""
    for horizon in (1, 3, 8):
        yield f"m = {horizon}", lambda horizon=horizon: (
            "1 % of speed at {:.1f} cells in a wavelength (simulated: {:.4f}), ".format(
                *bars.cells_for_one_per_cent(horizon)
            )
            + f"pulse of 55 cells loses {bars.smeared(horizon):.4f}, load on one node tears the end from "
            f"{bars.tearing_load(horizon):.2f} strengths on, on m nodes from {bars.tearing_load(horizon, horizon):.2f}"
        )
    for cells in (20.0, 60.0):
        yield f"seam, {cells:g} cells in a wavelength", lambda cells=cells: (
            f"returns {bars.seam_echo(cells):.5f}, without complement {bars.seam_echo(cells, complement=False):.4f}"
        )
    for method in bars.METHODS:
        yield f"spalls, {method}", lambda method=method: ", ".join(f"{x:.4f}" for x in bars.pieces(method))
    for courant in (1.0, 0.99, 0.9):
        yield f"sudden load, ν = {courant:g}", lambda courant=courant: (
            f"springs bear up to {bars.odd_even_swing(0.0, courant):.3f} of it"
        )
    for share in (1.0, 1.0001, 1.001):
        yield f"{share:g} of the limit", lambda share=share: (
            f"stops without breakage: {bars.stops(share, None)}, with: {bars.stops(share, 10e6)}"
        )
    yield "noise at 1.001 of the limit", lambda: "grown to 1e4 after {} steps".format(bars.above_the_limit()[0])
    for corrected in (False, True):
        yield f"viscous end, corrected_ends = {corrected}", lambda corrected=corrected: (
            f"returns {bars.soft_end(corrected):.4f}"
        )
    for horizon in (1, 3):
        yield f"families, m = {horizon}", lambda horizon=horizon: (
            f"by distance lose {bars.families_by_distance(horizon):.2f} of the outermost pairs; whole outermost volumes: "
            f"E_eff/E = {bars.too_stiff(horizon):.4f}"
        )


def main(results: Path) -> None:
    """Print all measurements, and draw the pictures into a folder."""
    for what, measurement in (*of_sides(), *of_grains(), *of_bars()):
        print(f"{what}: {measurement()}", flush=True)
    results.mkdir(parents=True, exist_ok=True)
    for name, draw in PICTURES.items():
        save(draw(), results / f"{name}.png")
        print(f"wrote {results / name}.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results/where_methods_fail"))

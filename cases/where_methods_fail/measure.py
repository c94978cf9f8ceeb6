"""Measures the thresholds of docs/evidence/where_methods_fail.md, prints them, and draws the pictures.

    python cases/where_methods_fail/measure.py [RESULTS]      (default: results/where_methods_fail)

It takes about a minute. The pictures are RESULTS/*.png.
"""

from collections.abc import Iterator

import bars
import ends
import grains
import sides
from oblique import reflection
from pictures import PICTURES
from report import report


def of_sides() -> Iterator[str]:
    """Dashpots, springs, columns: a line for each measurement."""
    for mass in (0.5, 1.0):
        yield f"lagged dampers, β = 2, end mass {mass:g}: stable up to {sides.lagged_limit(2.0, mass):.3f} of the limit"
    for beta in (1.04, 2.0, 1e4):
        reflected, grows = sides.strong_dashpot(beta)
        yield f"β = {beta:g}: reflects {reflected:.4f}; noise at 0.9995 of the limit grows: {grows}"
    for names in (("left",), ("left", "bottom")):
        hundredth, half = (sides.reach_of_springs(lost, names) / sides.DIAMETER for lost in (0.01, 0.5))
        yield f"springs at {' and '.join(names)}: step 1 % shorter at L = {hundredth:.4f} D, half at {half:.4f} D"
    velocity, expected = sides.drift()
    yield f"drift: {velocity:.6g} m/s, F/ΣC = {expected:.6g} m/s"
    for ratio in (1.0, 10.0, 100.0):
        measured, formula = sides.on_springs(ratio)
        yield f"springs, λ/L = {ratio:g}: reflect {measured:.4f}, formula {formula:.4f}"
    for motion in "ps":
        for angle in (0.0, 30.0, 60.0, 75.0, 85.0):
            found = reflection({"type": "viscous", "half_mass": True}, motion, angle)
            words = ", ".join(f"{name} {value:.4f}" for name, value in found.items())
            yield f"{motion.upper()} at {angle:g}°: {words}"
    for count in (20.0, 100.0, 500.0):
        whole, half = (sides.foot(half_mass, count) for half_mass in (False, True))
        yield f"foot of a column, {count:g} D in a wavelength: whole cells return {whole:.2e}, half cells {half:.2e}"
    for height in (10.0, 20.0, 40.0):
        yield f"bar {height:g} m high: calibrated over homogenised β, less 1: {sides.narrow(height):.4f}"
    yield f"bar periodic sideways: {sides.narrow(10.0, free=False):.5f}"


def of_grains() -> Iterator[str]:
    """Packings and contact laws: a line for each measurement."""
    for pattern in "ABC":
        for count in (10.0, 20.0, 40.0):
            late, lower = grains.pulse_along_bar(pattern, count)
            yield f"pattern {pattern}, {count:g} D in a wavelength: late by {late:.4f}, peak lower by {lower:.4f}"
    for length in (16.0, 20.0, 28.0, 40.0):
        wide, narrow = (grains.coda(length, brick) for brick in (10.0, 5.0))
        yield f"coda, wavelength {length:g} m: bricks of 10 m {wide:.4f}, of 5 m {narrow:.4f}"
    pull, push = grains.speed_of_tension()
    yield f"no tension: a pull runs at {pull:.4f} c, a push at {push:.4f} c"
    largest = ", ".join(f"{grains.locked_in_tension(seed):.2f}" for seed in (1, 2, 3))
    yield f"locked-in stress, three bricks: largest tension of a bond over the pressure {largest}"
    for ratio in (1.0, 0.5, 0.25):
        yield f"pb_rmul = {ratio:g}: breaks at a mean tension of {grains.thin_bond(ratio):.3f} pb_ten"
    for angle in (0.001, 0.01, 0.1):
        yield f"rotation by {angle:g}: stress {grains.stress_of_rotation(angle):.2e} ρc² in the geometry of the start"
    yield f"elastic start: left at a rotation of {grains.end_of_elastic_start():.4f}"
    measured, used = grains.opening_limit()
    yield f"contacts that open: stable up to {measured:.4f} of the linear limit, used up to {used:.4f}"


def of_bars() -> Iterator[str]:
    """Bars of nodes: a line for each measurement."""
    for horizon in (1, 3, 8):
        cells, error = bars.cells_for_one_per_cent(horizon)
        yield f"m = {horizon}: 1 % of speed at {cells:.1f} cells in a wavelength (simulated: {error:.4f})"
        yield f"m = {horizon}: a pulse of 55 cells loses {bars.smeared(horizon):.4f} of its peak over half the bar"
        one, spread = bars.tearing_load(horizon), bars.tearing_load(horizon, horizon)
        yield f"m = {horizon}: a load tears the end from {one:.2f} strengths on, on m nodes from {spread:.2f}"
    for cells in (20.0, 60.0):
        plain, without = bars.seam_echo(cells), bars.seam_echo(cells, complement=False)
        yield f"seam, {cells:g} cells in a wavelength: returns {plain:.5f}, without complement {without:.4f}"
    for method in bars.METHODS:
        yield f"spalls, {method}: {', '.join(f'{place:.4f}' for place in bars.pieces(method))} m"
    for energy in (400.0, 200.0, 100.0, 50.0):
        share, taken = bars.energy_of_a_spall(energy)
        yield f"horizon of {share:.2f} EG_f/σ_t²: open bonds of a spall take {taken:.3f} G_f"
    for energy, period in ((100.0, 480e-6), (100.0, 80e-6), (20.0, 240e-6)):
        apparent = 6.34 * bars.apparent_strength(period, energy)
        yield f"{energy:g} J/m², pulse of {1e6 * period:g} µs: pull-back {apparent:.2f} MPa of a bar with 6.34 MPa"
    for courant in (1.0, 0.99, 0.9):
        yield f"sudden load, ν = {courant:g}: springs bear up to {bars.odd_even_swing(0.0, courant):.3f} of it"
    for share in (1.0, 1.0001, 1.001):
        stops = [bars.stops(share, strength) for strength in (None, bars.STRENGTH)]
        yield f"{share:g} of the limit: stops without breakage: {stops[0]}, with: {stops[1]}"
    yield f"noise at 1.001 of the limit: grown to 1e4 after {bars.above_the_limit()} steps"
    for corrected in (False, True):
        yield f"viscous end, corrected_ends = {corrected}: returns {bars.soft_end(corrected):.4f}"
    for horizon in (1, 3):
        lost, stiffer = bars.families_by_distance(horizon), bars.too_stiff(horizon)
        yield f"m = {horizon}: families by distance lose {lost:.2f} of the outermost pairs"
        yield f"m = {horizon}: whole outermost volumes make E_eff/E = {stiffer:.4f}"


def of_ends() -> Iterator[str]:
    """Ends of bars under a pulse of 20 spacings: a line for each measurement."""
    for horizon in (1, 3, 8):
        for attenuation in (0.0, 0.5):
            tables = {"viscous": ends.VISCOUS} | {f"{nodes} nodes": ends.layer(nodes) for nodes in (20, 40, 80, 160)}
            for name, table in tables.items():
                echoes = [ends.sharp_echo(horizon, table, share, attenuation) for share in (0.5, 0.9)]
                words = ", ".join(f"{echo:.1e}" for echo in echoes)
                yield f"m = {horizon}, α = {attenuation:g} 1/m, {name}: returns {words} at 0.5, 0.9 of the limit"


if __name__ == "__main__":
    report((of_sides(), of_grains(), of_bars(), of_ends()), PICTURES, "results/where_methods_fail")

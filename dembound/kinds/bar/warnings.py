"""Warnings about probable mistakes in the case of a bar, known before the run."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from dembound.bar.scene import MOMENTS, BarScene, bar_medium, end_supports, entering_pressure, moments
from dembound.bar.stability import carrying_lattices, shortened_in_words
from dembound.boundaries import OPPOSITE, normal_axis
from dembound.boundaries.description import TOO_MUCH, poor_factor, reflected
from dembound.casefile.bar import BarCase
from dembound.casefile.magnitudes import (
    grip_stress,
    is_quasi_static,
    large_stress,
    large_velocity,
    stress_warnings,
    time_warnings,
)
from dembound.casefile.unlikely import unlikely_in
from dembound.kinds.bar.range_warnings import monitors_between_sections, monitors_in_gaps, range_warnings
from dembound.kinds.bar.summary import PERCENT, cells_of_waves
from dembound.meanings import fading
from dembound.words import percent, with_unit

_TOO_LARGE = "solids break or yield at some 0.3 %, are the units right?"

LIKELY = (100.0, 10_000.0)
"""Slowest and fastest waves (m/s) of bars of solids, from soft rubber to hard ceramics."""

BLURRED = 0.8
"""Share of its peak that must remain of a load spread over nodes.

Peridynamic bars need a load on as many nodes as the horizon has. A harmonic wave 5.6 times as long as the loaded part
keeps 0.80 of its peak, one of eight times 0.90; a pulse (1 − cos)/2 keeps 0.80 if it is 3.8 times as long.
"""

LONGEST = 0.25
"""Horizon over EG_f/σ_t² up to which a crack opens at one plane.

Under a pulse of 2.6 strengths a crack dissipates 1.00 to 1.04 of its fracture energy at 0.2, up to 1.3 at 0.4, and up
to 1.8 at 0.8.
"""


def bar_warnings(scene: BarScene, time_step: float) -> list[str]:
    """Warnings about a bar, one line each; time_step in s."""
    case = scene.case
    times = list(time_warnings(case, time_step, case.bar.travel_time))
    return [
        *filter(None, [shortened_in_words(scene, time_step)]),
        *_too_few_cells(scene, time_step),
        *(times or ends_too_soon(case)),  # with doubtful times of waves the second check means nothing
        *_dashpots_at_soft_ends(case),
        *_unmatched_dashpots(scene),
        *_loads_at_dashpots(case),
        *_loads_spread_too_far(case),
        *_long_bonds_across_cracks(case),
        *_too_tough(case),
        *stress_beside_strength(case),
        *_unlikely_speeds(case),
        *_large_strains(case),
        *_fades(case),
        *range_warnings(case, time_step),
        *monitors_in_gaps(scene),
        *monitors_between_sections(scene),
    ]


def _unlikely_speeds(case: BarCase) -> Iterator[str]:
    """Moduli and densities that are likely, but together give a wave speed that no rock, metal or plastic has."""
    given = [case.bar, *case.bar.range]
    if any(line for table in given for line in unlikely_in("", table, case)):
        return
    for number, part in enumerate(case.bar.parts, start=1):
        if not LIKELY[0] <= part.speed <= LIKELY[1]:
            place = f"bar.range[{number}]" if case.bar.range else "bar"
            yield (
                f"{place}: its wave speed is {part.speed:.4g} m/s, of solids {LIKELY[0]:g} to {LIKELY[1]:,g}; is the "
                "density in kg/m³ and the stiffness in Pa?"
            )


def _large_strains(case: BarCase) -> Iterator[str]:
    """Waves, impacts, loads and strengths whose strains are far beyond those of solids."""
    bar = case.bar
    for side, waves in case.driving.items():
        place = f"wave.{waves['p']}"
        yield from large_velocity(place, case.wave[waves["p"]].peak(), bar.end(side).speed, _TOO_LARGE)
    for given, part in zip(bar.range, bar.parts, strict=False):
        yield from large_velocity(f"bar.range.{given.name}.velocity", abs(given.velocity), part.speed, _TOO_LARGE)
    for load in case.load if np.isinf(bar.least_strength) else ():  # others are compared with the strength
        stress = abs(load.pressure) * case.wave[load.wave].peak()
        yield from large_stress(f"load.{load.name}: its pressure", stress, bar.end(load.side).modulus, _TOO_LARGE)
    for part in bar.parts:
        if part.strength is not None:
            yield from large_stress("bar.strength:", part.strength, part.modulus, _TOO_LARGE)


def _fades(case: BarCase) -> Iterator[str]:
    """Attenuation that leaves nothing of a wave."""
    along = sum(part.attenuation * part.length for part in case.bar.parts)
    yield from fading("bar.attenuation", along, case.bar.length)


def _too_few_cells(scene: BarScene, time_step: float) -> Iterator[str]:
    """Waves that are too short for the spacing of the nodes, except for those of a slow grip."""
    travel = scene.case.bar.travel_time
    finer = "" if all(row.horizon == 1 for row in carrying_lattices(scene, time_step)) else " or method.horizon"
    for name, (cells, needed) in cells_of_waves(scene, time_step).items():
        if cells < needed and not is_quasi_static(scene.case, name, travel):
            few = f"{cells:.3g} cells" if cells >= 1.0 else "less than one cell"
            yield (
                f"wave.{name}: has {few} in its shortest wavelength, fewer than the {needed:.3g} that keep "
                f"the error of its speed under {PERCENT}; take a smaller bar.spacing{finer}"
            )


def _long_bonds_across_cracks(case: BarCase) -> Iterator[str]:
    """Horizons so long that a crack opens over several planes."""
    for part in case.bar.parts:
        horizon = case.method.largest_horizon * part.spacing
        if part.fracture_energy is None or case.method.largest_horizon == 1:
            continue
        if horizon > LONGEST * part.characteristic_length:
            yield (
                f"method.horizon: is {horizon:.4g} m long, {horizon / part.characteristic_length:.2g} of EG_f/σ_t²; "
                f"above {LONGEST:g} cracks may spread over several planes and take more than bar.fracture_energy; take "
                "a smaller horizon"
            )


def _dashpots_at_soft_ends(case: BarCase) -> Iterator[str]:
    """Dashpots at the soft ends of plain peridynamics."""
    for side, table in case.boundary.items():
        if case.method.soft_ends and table.factors:
            yield (
                f"boundary.{side}: is at a soft end of peridynamics and reflects a part of every wave; "
                "give method.corrected_ends = true"
            )


def _loads_at_dashpots(case: BarCase) -> Iterator[str]:
    """Loads on ends that absorb: dashpots or a layer beyond take a part of the load, and only the rest enters."""
    for load in case.load:
        end, supports = case.bar.end(load.side), end_supports(case, load.side)
        impedance = end.density * end.speed * end.area
        beyond = impedance if case.side(load.side).layer else float(supports.damping.sum())
        if beyond > TOO_MUCH * impedance:
            taken = beyond / (impedance + beyond)
            stress = with_unit((1.0 - taken) * abs(load.pressure) * case.wave[load.wave].peak(), "Pa")
            yield (
                f"load.{load.name}: is on an end that absorbs: boundary.{load.side} takes {percent(taken, 3)} of it, "
                f"and up to {stress} enters the bar; on a free end all of it does"
            )


def _loads_spread_too_far(case: BarCase) -> Iterator[str]:
    """Loads on so many nodes that they smooth their waves and reduce the peak.

    A force at a distance x from a free end sends half of its wave away from the end and half towards it, which returns
    with the same sign after 2x/c. Forces within W together send the mean of f(t) over ± W/c, which keeps the share
    sin(ωW/c)/(ωW/c) of a frequency ω. An end that absorbs returns nothing, so that the mean is over ± W/2c.
    """
    for load in case.load:
        end, wave, absorbs = case.bar.end(load.side), case.wave[load.wave], not case.side(load.side).is_free
        wide = (load.nodes - 0.5) * end.length / end.cells
        half = wide / end.speed * (0.5 if absorbs else 1.0)
        last = wave.duration() if np.isfinite(wave.duration()) else wave.peak_time() + wave.time_scale()
        time = np.union1d(np.linspace(wave.begin() - half, last + half, MOMENTS), [wave.peak_time()])
        means = np.abs(wave.displacement(time + half) - wave.displacement(time - half)) / (2.0 * half)
        if (share := float(means.max()) / wave.peak()) < BLURRED:
            entering = share * abs(load.pressure) * wave.peak()
            yield (
                f"load.{load.name}.nodes: is {load.nodes}, {wide:.3g} m, so long beside its wave that only "
                f"{percent(share)} of its peak enters, {with_unit(entering, 'Pa')}; take fewer nodes"
            )


def _too_tough(case: BarCase) -> Iterator[str]:
    """A fracture energy above the energy of all waves that enter: no crack can open completely."""
    bar = case.bar
    if bar.range or bar.fracture_energy is None or not (case.load or case.driving):
        return
    energy = 0.0
    for side in ("left", "right"):
        if end_supports(case, side).prescribed.any():
            return  # grips work as long as the run lasts
        time = moments(case, side)
        time = np.minimum(time, case.run.duration)
        power = entering_pressure(case, side, time) ** 2 / (bar.density * bar.speed)
        energy += float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(time)))
    if 0.0 < energy < bar.fracture_energy:
        yield (
            f"bar.fracture_energy: is {bar.fracture_energy:.4g} J/m², more than all waves bring in, {energy:.3g} J/m², "
            "so no crack can open all the way; is it in J/m² (1 N/mm is 1,000 J/m²)?"
        )


def _unmatched_dashpots(scene: BarScene) -> Iterator[str]:
    """Dashpots that reflect much of a wave; the matched factor of a bar is 1."""
    for side, edge in scene.edges.items():
        table = scene.case.side(side)
        beta = table.factors_at(edge, bar_medium(scene.case, side)).get("p", 1.0)
        if (share := abs(reflected(beta, 1.0))) > TOO_MUCH:
            yield f"boundary.{side}: {poor_factor(['p'], [share], beta, [1.0], table.waves.get('p'))}"


def stress_beside_strength(case: BarCase) -> Iterator[str]:
    """Loads and waves whose stress is a very small part, or a large multiple, of the strength."""
    bar = case.bar
    strength = bar.least_strength
    if np.isinf(strength):
        return
    stresses = {
        f"load.{load.name}": ("its pressure", abs(load.pressure) * case.wave[load.wave].peak()) for load in case.load
    }
    for side, waves in case.driving.items():
        wave = case.wave[waves["p"]]
        if 0 in case.side(side).prescribed(normal_axis(side)):
            end = bar.end(side)
            found = grip_stress(wave, end.density, end.speed, bar.length, case.run.duration, strength)
        else:
            pressure = entering_pressure(case, side, moments(case, side), loads=False)
            found = "its stress ρcv", float(np.abs(pressure).max())
        stresses[f"wave.{waves['p']}"] = found
    key = "bar.strength" if bar.critical_stretch is None else "bar.critical_stretch"
    key = "bar.range" if bar.range else key
    yield from stress_warnings(stresses, strength, key)


def ends_too_soon(case: BarCase) -> Iterator[str]:
    """A run that is over before the wave is back from the free end, where the bar could spall."""
    far = OPPOSITE.get(case.loaded)
    if far is None or not case.side(far).is_free or case.bar.range:
        return  # with ranges an interface may return tension earlier
    if np.isinf(case.bar.breaking_stretch):
        return
    duration, there = case.run.duration, case.bar.length / case.bar.speed
    crest, broken = _crest_and_break(case)
    if broken is not None and duration < there + broken:
        yield (
            f"run.duration: is {duration:g} s, too short for a spall: the wave is not back from the free {far} "
            f"end with a tension of the strength before {there + broken:.4g} s"
        )
    elif broken is None and crest is not None and duration < there + crest:
        yield (
            f"run.duration: is {duration:g} s, too short for any tension: the wave's crest is not at the free {far} "
            f"end, which returns it as tension, before {there + crest:.4g} s"
        )


def _crest_and_break(case: BarCase) -> tuple[float | None, float | None]:
    """Times of the pressure's crest at the loaded end and of the break near the other end, less L/c; s.

    A pressure p(t) on the loaded end gives the tension p(s − y/c) − p(s + y/c) at the distance y from the free end,
    with s the time since the front arrived there. A time is None where the event does not occur: no pressure, too low a
    pressure, or an initial tension so large that the bar breaks before the front arrives. Both times are None where the
    loaded end has springs.
    """
    bar, side = case.bar, case.loaded
    if end_supports(case, side).stiffness.any():
        return None, None
    strength = bar.breaking_stretch * bar.modulus
    time = moments(case, side)
    pressure = entering_pressure(case, side, time)
    if not pressure.max() > 0.0 or -pressure.min() >= strength:
        return None, None
    way = np.linspace(0.0, min(time[-1] - time[0], bar.length / bar.speed), MOMENTS)
    before, after = (entering_pressure(case, side, time[:, None] + sign * way) for sign in (-1.0, 1.0))
    reached = (before - after).max(axis=1) >= strength
    return float(time[pressure.argmax()]), float(time[reached.argmax()]) if reached.any() else None

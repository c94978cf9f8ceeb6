"""Facts about the case of a bar, computed without running it."""

import math

import numpy as np

from dembound.bar.end_echo import ROUNDING, returned_of_waves
from dembound.bar.lattice import carrying_lattices
from dembound.bar.scene import BarScene
from dembound.bar.stability import unit_step
from dembound.bar.summary import describe_bar, describe_end
from dembound.boundaries.words import side_in_words
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import COARSEST, Bar
from dembound.casefile.bar.range import BarRange
from dembound.casefile.magnitudes import stress_in_words, waves_used
from dembound.casefile.messages import counted, show
from dembound.exact.dispersion import cells_per_wavelength

ERROR = 0.01
"""Error of the phase speed that the shortest wavelength may have without a warning."""

PERCENT = f"{100.0 * ERROR:g} %"
"""`ERROR` in percent, as text."""


def bar_facts(scene: BarScene, time_step: float) -> dict[str, str]:
    """Facts about a bar and its method, ready to print."""
    bar = describe_bar(scene)
    case = scene.case
    apart = " and ".join(f"{size:g}" for size in dict.fromkeys(part.spacing for part in case.bar.parts))
    facts = {
        "nodes": f"{scene.count:,}, {apart} m apart",
        "method": method_in_words(case),
        "Courant number": f"{time_step / unit_step(scene):.4g}",
        "bar": f"{case.bar.length:g} m long",
    }
    if case.bar.range:
        parts = zip(case.bar.range, case.bar.starts, case.bar.parts, strict=True)
        facts |= {f"range {given.name}": _range_in_words(given, start, part) for given, start, part in parts}
    else:
        facts["bar"] += f", section {bar['section']:.4g} m², density {bar['density']:g} kg/m³"
        facts["stiffness"] = f"E = {case.bar.modulus / 1e9:.4g} GPa, c = {case.bar.speed:.4g} m/s"
        facts["strength"] = _strength_in_words(case.bar)
        if case.bar.fracture_energy is not None:
            facts["cracks"] = _cracks_in_words(case.bar)
        if case.bar.strength_rates is not None:
            facts["strain rates"] = _rates_in_words(case.bar)
        if case.bar.attenuation > 0.0:
            facts["attenuation"] = f"α = {case.bar.attenuation:g} 1/m"
    for side in scene.edges:
        facts[f"{side} end"] = side_in_words(describe_end(scene, side)) + _echo_in_words(scene, side, time_step)
    for load in case.load:
        facts[f"load {load.name}"] = (
            f"{_pressure(load.pressure, case.wave[load.wave].peak())} times wave {load.wave}, "
            f"on {counted(load.nodes, 'node')} at the {load.side} end"
        )
    for name, node in scene.monitors.items():
        facts[f"monitor {name}"] = f"node {node} at {scene.positions[node, 0]:.4g} m"
    for name, (cells, needed) in cells_of_waves(scene, time_step).items():
        facts[f"wave {name}"] = (
            f"{cells:.3g} cells in its shortest wavelength, {needed:.3g} needed for an error of {PERCENT}"
        )
    return facts


def _echo_in_words(scene: BarScene, side: str, time_step: float) -> str:
    """The most that an absorbing end returns of every wave in use; empty where it is not known."""
    found = returned_of_waves(scene, side, time_step)
    most = {name: share for name, share in found.shares.items() if share > 2.0 * ROUNDING}
    words = []
    if most:
        words.append(f"at most {', '.join(f'{_rounded_up(share)} of wave {name}' for name, share in most.items())}")
        if np.isfinite(found.within):
            words[0] += f" within {found.within:.2g} s after it"
    if nothing := [name for name in found.shares if name not in most]:
        words.append(f"nothing of wave {', '.join(nothing)} but rounding errors")
    return f"; returns {' and '.join(words)}" if words else ""


def _rounded_up(share: float) -> str:
    """A number above 0 with two digits, not below it."""
    unit = 10.0 ** (math.floor(math.log10(share)) - 1)
    return f"{math.ceil(share / unit) * unit:.2g}"


def _pressure(pressure: float, peak: float) -> str:
    """Pressure (Pa) of a load in words, and the largest stress if the peak of its wave is not 1."""
    given, largest = stress_in_words(pressure), stress_in_words(abs(pressure) * peak)
    return given if largest == stress_in_words(abs(pressure)) else f"up to {largest}: {given}"


def method_in_words(case: BarCase) -> str:
    """The method and its keys."""
    keys = case.method.model_dump(exclude={"type"})
    return f"{case.method.type}" + "".join(f", {key} = {show(value)}" for key, value in keys.items())


def _range_in_words(given: BarRange, start: float, part: Bar) -> str:
    """Place, material, motion and left interface of a range."""
    words = [
        f"{start:.4g} to {start + part.length:.4g} m, section {part.area:.4g} m²",
        f"ρ = {part.density:g} kg/m³, c = {part.speed:.4g} m/s, ρcA = {part.density * part.speed * part.area:.4g} kg/s",
        _strength_in_words(part),
    ]
    words += [_cracks_in_words(part)] * (part.fracture_energy is not None)
    words += [_rates_in_words(part)] * (part.strength_rates is not None)
    words += [f"α = {part.attenuation:g} 1/m"] * (part.attenuation > 0.0)
    words += [f"starts at {given.velocity:g} m/s"] * (given.velocity != 0.0)
    if given.interface == "contact":
        words.append("touches the range on its left" + f" once a gap of {given.gap:g} m is closed" * (given.gap > 0.0))
    return "; ".join(words)


def _strength_in_words(bar: Bar) -> str:
    """Stress and stretch at which the bar breaks."""
    stretch = bar.breaking_stretch
    if np.isinf(stretch):
        return "unbreakable"
    return f"{stretch * bar.modulus / 1e6:.4g} MPa, critical stretch {stretch:.4g}"


def _cracks_in_words(bar: Bar) -> str:
    """Fracture energy, opening at which a crack bears nothing, and the lengths that follow from them."""
    if bar.fracture_energy is None:
        return ""
    length = bar.characteristic_length
    opening = bar.fracture.opening(bar.breaking_stretch * bar.modulus)
    return (
        f"G_f = {bar.fracture_energy:g} J/m², open at w_c = 2G_f/σ_t = {opening * 1e6:.4g} µm, characteristic length "
        f"EG_f/σ_t² = {length * 1e3:.4g} mm, spacing at most {COARSEST * length * 1e3:.4g} mm"
    )


def _rates_in_words(bar: Bar) -> str:
    """Strength at the slowest and at the fastest strain rate."""
    if bar.strength_rates is None:
        return ""
    slowest, fastest = bar.strength_rates
    strength = bar.breaking_stretch * bar.modulus
    return (
        f"strength from {strength / 1e6:.4g} MPa at {slowest:g} 1/s to {bar.largest_strength / 1e6:.4g} MPa at "
        f"{fastest:g} 1/s"
    )


def cells_of_waves(scene: BarScene, time_step: float) -> dict[str, tuple[float, float]]:
    """For every wave in use: cells in its shortest wavelength, and cells needed for a speed error below ERROR.

    The shortest wavelength is that of the wave's highest frequency. Of the ranges it is the one where cells are fewest
    for what is needed.
    """
    rows = carrying_lattices(scene, time_step)
    needed = [
        cells_per_wavelength(row.horizon, min(row.courant, row.courant_limit), ERROR, shares=row.shares) for row in rows
    ]
    coarse = min(range(len(rows)), key=lambda r: rows[r].wave_speed / (rows[r].spacing * needed[r]))
    row, case = rows[coarse], scene.case
    used = waves_used(case)
    fading = {name: wave.highest_frequency() for name, wave in case.wave.items() if name in used}
    return {
        name: (row.wave_speed / (f * row.spacing) if f > 0.0 else np.inf, needed[coarse]) for name, f in fading.items()
    }

"""Facts about the case of a bar, computed without running it."""

import math
from collections.abc import Sequence

import numpy as np

from dembound.bar.linear_steps import carrying_lattices
from dembound.bar.scene import BarScene
from dembound.bar.stability import unit_step
from dembound.boundaries.description import side_in_words
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import COARSEST, Bar, BarRange
from dembound.casefile.magnitudes import waves_used
from dembound.casefile.messages import counted, show
from dembound.exact.dispersion import cells_per_wavelength
from dembound.formulas.bars.ends import ROUNDING, returned_of_waves
from dembound.kinds.bar.summary import describe_end, part_quantities
from dembound.words import Entries, Quantity, percent, sentences, with_unit

ERROR = 0.01
"""Error of the phase speed that the shortest wavelength may have without a warning."""

PERCENT = f"{100.0 * ERROR:g} %"
"""`ERROR` as a percentage."""


def bar_facts(scene: BarScene, time_step: float) -> Entries:
    """Facts about a bar and its method, ready to print."""
    case = scene.case
    apart = " and ".join(with_unit(size, "m") for size in dict.fromkeys(part.spacing for part in case.bar.parts))
    yield "nodes", f"{scene.count:,}, {apart} apart"
    yield "method", method_in_words(case)
    yield "Courant number", f"{time_step / unit_step(scene):.3g}"
    if case.bar.range:
        yield "bar", f"{case.bar.length:g} m long"
        for given, start, part, own in zip(
            case.bar.range, case.bar.starts, case.bar.parts, scene.rod.ranges, strict=True
        ):
            yield f"range {given.name}", _range_in_words(given, start, part, part_quantities(part, own))
    else:
        yield from _bar_facts(scene)
    for side in scene.edges:
        yield f"{side} end", side_in_words(describe_end(scene, side)) + _echo_in_words(scene, side, time_step)
    for load in case.load:
        pressure = f"{_pressure(load.pressure, case.wave[load.wave].peak())} times wave {load.wave}"
        yield f"load {load.name}", f"{pressure}, on {counted(load.nodes, 'node')} at the {load.side} end"
    for name, node in scene.monitors.items():
        yield f"monitor {name}", f"node {node} at {scene.positions[node, 0]:.4g} m"
    for name, (cells, needed) in cells_of_waves(scene, time_step).items():
        words = f"{cells:.3g} cells in its shortest wavelength, {needed:.3g} needed for an error of {PERCENT}"
        joined = case.wave[name].joined()
        yield f"wave {name}", words + (f"; {joined}" if joined else "")


def _bar_facts(scene: BarScene) -> Entries:
    """Length, section and material of a uniform bar."""
    found = part_quantities(scene.case.bar, scene.rod.ranges[0])
    yield "bar", sentences(found, "length", "section", "density")
    yield "stiffness", sentences(found, "youngs_modulus", "wave_speed")
    yield from _material_facts(scene.case.bar, found)


def _echo_in_words(scene: BarScene, side: str, time_step: float) -> str:
    """The largest reflection of every wave in use by an absorbing end; empty where it is not known."""
    found = returned_of_waves(scene, side, time_step)
    most = {name: share for name, share in found.shares.items() if share > 2.0 * ROUNDING}
    words = []
    if most:
        words.append(f"at most {', '.join(f'{_rounded_up(share)} of wave {name}' for name, share in most.items())}")
        if found.part < 1.0:
            words[0] += f", at {percent(found.part)} of the nodes,"
        if np.isfinite(found.within):
            words[0] += f" within {found.within:.2g} s after it"
    if nothing := [name for name in found.shares if name not in most]:
        words.append(f"nothing of wave {', '.join(nothing)} but rounding errors")
    unknown = f"; not computed for wave {', '.join(found.unknown)}, too long or too short" if found.unknown else ""
    return (f"; returns {' and '.join(words)}" if words else "") + unknown


def _rounded_up(share: float) -> str:
    """A number above 0 with two digits, not below it."""
    unit = 10.0 ** (math.floor(math.log10(share)) - 1)
    return f"{math.ceil(share / unit) * unit:.2g}"


def _pressure(pressure: float, peak: float) -> str:
    """Pressure (Pa) of a load in words, and the largest stress if the peak of its wave is not 1."""
    given, largest = with_unit(pressure, "Pa"), with_unit(abs(pressure) * peak, "Pa")
    return given if largest == with_unit(abs(pressure), "Pa") else f"up to {largest}: {given}"


def method_in_words(case: BarCase) -> str:
    """The method and its keys."""
    keys = case.method.model_dump(exclude={"type"})
    return f"{case.method.type}" + "".join(f", {key} = {show(value)}" for key, value in keys.items())


def _range_in_words(given: BarRange, start: float, part: Bar, found: Sequence[Quantity]) -> str:
    """Place, material, motion and left interface of a range."""
    words = [
        f"{start:.4g} to {start + part.length:.4g} m, {sentences(found, 'section')}",
        f"ρ = {part.density:g} kg/m³, c = {part.speed:.4g} m/s, ρcA = {part.density * part.speed * part.area:.4g} kg/s",
        *(text for _, text in _material_facts(part, found)),
    ]
    words += [f"starts at {given.velocity:g} m/s"] * (given.velocity != 0.0)
    if given.interface == "contact":
        words.append("touches the range on its left" + f" once a gap of {given.gap:g} m is closed" * (given.gap > 0.0))
    return "; ".join(words)


def _material_facts(bar: Bar, found: Sequence[Quantity]) -> Entries:
    """The stress and stretch at which a bar breaks, how its cracks open, its strain rates, and its attenuation."""
    yield "strength", sentences(found, "strength", "critical_stretch") or "unbreakable"
    if bar.fracture_energy is not None:
        opens = sentences(found, "fracture_energy", "crack_opening", "characteristic_length")
        yield "cracks", f"{opens}, spacing at most {with_unit(COARSEST * bar.characteristic_length, 'm')}"
    if bar.strength_rates is not None:
        slowest, fastest = (f"{rate:g} 1/s" for rate in bar.strength_rates)
        largest = with_unit(bar.largest_strength, "Pa")
        yield "strain rates", f"strength from {sentences(found, 'strength')} at {slowest} to {largest} at {fastest}"
    if bar.attenuation > 0.0:
        yield "attenuation", sentences(found, "attenuation")


def cells_of_waves(scene: BarScene, time_step: float) -> dict[str, tuple[float, float]]:
    """For every wave in use: cells in its shortest wavelength, and cells needed for a speed error below ERROR.

    The shortest wavelength is that of the wave's highest frequency, in the range where cells are fewest relative to the
    number needed.
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

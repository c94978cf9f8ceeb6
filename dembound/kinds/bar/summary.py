"""A bar in words and numbers: facts about the case, without running it, and the results of a run."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from dembound.bar.fracture import Spall, breaks_at_ends, crack_strain_rates, spalls
from dembound.bar.scene import BarPart, BarScene, bar_medium
from dembound.bar.stability import carrying_lattices, unit_step
from dembound.boundaries.description import side_in_words
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import COARSEST, Bar, BarRange
from dembound.casefile.magnitudes import waves_used
from dembound.casefile.messages import counted, show
from dembound.exact.bar import cells_per_wavelength
from dembound.formulas.bars.ends import ROUNDING, returned_of_waves
from dembound.gauge.estimates import pull_back_strength
from dembound.methods.rod import Range
from dembound.motion.trackers import Run
from dembound.results.reader import open_record
from dembound.results.warnings import share_of_supplied
from dembound.words import Entries, Quantity, numbers, percent, sentences, with_unit

LATER_SPALLS = "spalls after the first do not converge as bar.spacing decreases: their number and places depend on it"
"""Note in the summary where a bar without a fracture energy has spalled more than once."""

AT_ONE_HORIZON = (
    "spalls after the first converge as bar.spacing decreases if the method is peridynamics and its horizon mΔx "
    "remains the same; else their number and places may depend on bar.spacing"
)
"""Note in the summary where a bar with a fracture energy has spalled more than once."""


OF_DISKS = {"beta_s", "matched_p", "matched_s", "half_mass"}
"""Keys of sides that do not apply to bars, which move only along their axis and whose end nodes are half cells."""


def summarise_bar(scene: BarScene, run: Run, record: Path) -> dict[str, Any]:
    """Additional entries of a summary for bars: plain JSON values, SI units."""
    bar = part_of(run)
    found, at_ends = spalls_of(scene, run)
    note = AT_ONE_HORIZON if scene.case.bar.opens else LATER_SPALLS  # whether later spalls converge
    return {
        "nodes": scene.count,
        "method": scene.case.method.model_dump(),
        "bond_updates": bar.bond_updates,
        "courant": max(run.time_step * part.speed / part.spacing for part in scene.rod.ranges),
        "spalls": [spall.describe() for spall in found],
        "breaks_at_ends": {side: spall.describe() for side, spall in at_ends.items()},
        "spalls_note": note if len(found) > 1 else None,
        "open_contacts": _open_contacts(scene, bar),
        "crack_strain_rates": crack_strain_rates(bar.bonds),
        "bar": describe_bar(scene),
        "boundaries": {side: describe_end(scene, side) for side in scene.edges},
        "stress": _largest_stresses(record),
        "pull_back_strength": _pull_backs(scene, record) if found else {},
    }


def _open_contacts(scene: BarScene, bar: BarPart) -> list[str]:
    """Names of the ranges whose contact with the one on their left has never been closed."""
    right = [given.name for given in scene.case.bar.range if given.interface == "contact"]
    return [name for name, closed in zip(right, bar.bonds.closed, strict=True) if not closed]


def spalls_of(scene: BarScene, run: Run) -> tuple[list[Spall], dict[str, Spall]]:
    """The spalls of a run in order of time, and the breaks at held ends: side -> break."""
    places = spalls(part_of(run).bonds, scene.positions[:, 0], run.time_step)
    at_ends = breaks_at_ends(places, _held_ends(scene))
    return [place for place in places if place not in at_ends.values()], at_ends


def part_of(run: Run) -> BarPart:
    """The only part of a bar's run."""
    (bar,) = run.system.parts
    return cast(BarPart, bar)


def describe_bar(scene: BarScene) -> dict[str, Any]:
    """The bar in numbers: lengths m, area m², moduli Pa, speed m/s; strength and stretch null where nothing breaks.

    A bar with ranges has these numbers for each range, its length, and its smallest strength.
    """
    bar, ranges = scene.case.bar, scene.rod.ranges
    if not bar.range:
        return numbers(part_quantities(bar, ranges[0]))
    each = [
        {"name": given.name, "start": start, "interface": given.interface, "velocity": given.velocity}
        | numbers(part_quantities(part, own))
        for given, start, part, own in zip(bar.range, bar.starts, bar.parts, ranges, strict=True)
    ]
    strength = bar.least_strength if np.isfinite(bar.least_strength) else None
    return {"length": bar.length, "strength": strength, "ranges": each}


def part_quantities(bar: Bar, own: Range) -> list[Quantity]:
    """The numbers of a uniform bar or of a range, of bars that do not break or open without those of it."""
    stretch = bar.breaking_stretch if np.isfinite(bar.breaking_stretch) else None
    strength, opening, length = bar.breaking_stretch * bar.modulus, None, None
    if bar.fracture_energy:
        opening, length = bar.fracture.opening(strength), bar.characteristic_length
    return [
        Quantity("length", "m", bar.length, "{:g} m long"),
        Quantity("spacing", "m", own.spacing),
        Quantity("section", "m²", bar.area, "section {:.4g} m²"),
        Quantity("density", "kg/m³", bar.density, "density {:g} kg/m³"),
        Quantity("youngs_modulus", "Pa", bar.modulus, "E = {}"),
        Quantity("wave_speed", "m/s", bar.speed, "c = {}"),
        Quantity("impedance", "kg/(m² s)", bar.density * bar.speed),
        Quantity("critical_stretch", "1", stretch, "critical stretch {:.3g}"),
        Quantity("strength", "Pa", None if stretch is None else strength, "{}"),
        Quantity("attenuation", "1/m", bar.attenuation, "α = {:g} 1/m"),
        Quantity("fracture_energy", "J/m²", bar.fracture_energy, "G_f = {:g} J/m²"),
        Quantity("crack_opening", "m", opening, "open at w_c = 2G_f/σ_t = {}"),
        Quantity("characteristic_length", "m", length, "characteristic length EG_f/σ_t² = {}"),
    ]


def describe_end(scene: BarScene, side: str) -> dict[str, Any]:
    """One end in numbers: its type, and the numbers of its table that apply to bars."""
    table = scene.case.side(side)
    numbers = table.describe(scene.edges[side], bar_medium(scene.case, side))
    if side in scene.layers:
        numbers["layer_length"] = float(f"{scene.layers[side].length:.12g}")
    return {"type": table.type} | {key: value for key, value in numbers.items() if key not in OF_DISKS}


def _held_ends(scene: BarScene) -> dict[str, float]:
    """Ends whose node a boundary moves or holds: side -> place, m."""
    return {
        side: float(scene.positions[edge.nodes[0], 0])
        for side, edge in scene.edges.items()
        if 0 in scene.case.side(side).prescribed(edge.axis)
    }


def _largest_stresses(record: Path) -> dict[str, dict[str, float]]:
    """Largest tension and compression (Pa) at every monitor."""
    with open_record(record) as file:
        histories = {name: group["stress"][:] for name, group in file["histories"].items()}
    return {
        name: {"tension": float(max(stress.max(), 0.0)), "compression": float(min(stress.min(), 0.0))}
        for name, stress in histories.items()
    }


def _pull_backs(scene: BarScene, record: Path) -> dict[str, float]:
    """Pull-back strength (Pa) of every monitor at a free end whose velocity falls and rises again.

    A loaded end is left out, as the load determines its motion.
    """
    loaded = {load.side for load in scene.case.load}
    free = [side for side in scene.edges if describe_end(scene, side)["type"] == "free" and side not in loaded]
    outwards = {int(scene.edges[side].nodes[0]): -1.0 if side == "left" else 1.0 for side in free}
    ends = {name: outwards[node] for name, node in scene.monitors.items() if node in outwards}
    bar = scene.case.bar.parts[0]
    if scene.case.bar.range:
        return {}  # waves between interfaces overlap at the end
    with open_record(record) as file:
        moved = {
            name: (file[f"histories/{name}/time"][:], sign * file[f"histories/{name}/velocity"][:, 0])
            for name, sign in ends.items()
        }
    found = {name: pull_back_strength(*each, bar.density, bar.speed, bar.length) for name, each in moved.items()}
    return {name: strength for name, strength in found.items() if not np.isnan(strength)}


GAINED = 1e-3
"""Share of the energy above which a run reports energy that breaking bonds added instead of removing it."""

LISTED = 3
"""Number of spalls that are printed one by one."""


def bar_outcome(summary: Mapping[str, Any]) -> list[str]:
    """Changes of method, places and times of breaks and spalls, and which of these results converge."""
    facts = [f"{used['law']} from {with_unit(used['from'], 's')}" for used in summary["laws"][1:]]
    facts += [
        f"broke at the {side} end ({summary['boundaries'][side]['type']}), {with_unit(broken['time'], 's')}"
        for side, broken in summary["breaks_at_ends"].items()
    ]
    facts += [
        f"spall at {_range(spall['start'])} m, {with_unit(spall['time'], 's')}" for spall in summary["spalls"][:LISTED]
    ]
    if (more := len(summary["spalls"]) - LISTED) > 0:
        facts.append(f"and {more} more, see summary.json")
    if summary["spalls_note"] is not None:
        facts.append(summary["spalls_note"])
    if not summary["spalls"] and not summary["breaks_at_ends"] and summary["bar"]["strength"] is not None:
        facts.append("no spall")
    gained, supplied = -summary["energy"]["crack"], summary["energy"]["supplied"]
    if gained > GAINED * supplied:
        facts.append(
            f"bonds broke within single steps, adding {share_of_supplied(gained, supplied)}, "
            "take a smaller bar.spacing or run.courant"
        )
    if error := summary["energy"]["relative_error"]:
        facts.append(f"largest error of the energy balance: {percent(error)}")
    return facts


def _range(ends: Sequence[float]) -> str:
    """Ends of a range as "0.906–0.909", or a single position."""
    return "–".join(f"{end:.4g}" for end in sorted(set(ends)))


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

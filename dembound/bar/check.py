"""What a bar's case would come to, without running it."""

import numpy as np

from dembound.bar.scene import BarScene
from dembound.bar.summary import describe_bar, describe_end
from dembound.boundaries.driven import Driven
from dembound.boundaries.viscous import Dashpots
from dembound.case import BarCase
from dembound.case.bar import Bar
from dembound.exact.dispersion import cells_per_wavelength, courant_limit
from dembound.waves import Record

ERROR = 0.01
"""Error of the phase speed that the shortest wavelength may have without a warning."""

PERCENT = f"{100.0 * ERROR:g} %"
"""The same in words."""

LONG = 1000.0
"""A record this many times as long as the run probably counts its times in microseconds."""


def bar_facts(scene: BarScene, time_step: float) -> dict[str, str]:
    """Facts about a bar and its method, ready to print."""
    bar = describe_bar(scene)
    case = scene.case
    facts = {
        "nodes": f"{scene.count:,}, {bar['spacing']:g} m apart",
        "method": method_in_words(case),
        "Courant number": f"{_courant(case, time_step):.6g}",
        "bar": f"{bar['length']:g} m long, section {bar['section']:.4g} m², density {bar['density']:g} kg/m³",
        "stiffness": f"E = {case.bar.modulus / 1e9:.4g} GPa, c = {case.bar.speed:.4g} m/s",
        "strength": _strength_in_words(case.bar),
    }
    if case.bar.attenuation > 0.0:
        facts["attenuation"] = f"{case.bar.attenuation:g} 1/m"
    for side in scene.edges:
        facts[f"{side} end"] = str(describe_end(scene, side)["type"])
    for load in case.load:
        largest = abs(load.pressure) * case.wave[load.wave].peak()
        facts[f"load {load.name}"] = (
            f"up to {largest / 1e6:.4g} MPa, {load.pressure:.4g} Pa times wave {load.wave}, "
            f"on {load.nodes} node(s) at the {load.side} end"
        )
    for name, node in scene.monitors.items():
        facts[f"monitor {name}"] = f"node {node} at {scene.positions[node, 0]:.4g} m"
    for name, (cells, needed) in cells_of_waves(case, time_step).items():
        facts[f"wave {name}"] = (
            f"{cells:.3g} cells in its shortest wavelength, {needed:.3g} needed for an error of {PERCENT}"
        )
    return facts


def method_in_words(case: BarCase) -> str:
    """The method and its keys."""
    keys = case.method.model_dump(exclude={"type"})
    return f"{case.method.type}" + "".join(f", {key} = {value}" for key, value in keys.items())


def _strength_in_words(bar: Bar) -> str:
    """Stress and stretch at which it breaks."""
    stretch = bar.breaking_stretch
    if np.isinf(stretch):
        return "unbreakable"
    return f"{stretch * bar.modulus / 1e6:.4g} MPa, critical stretch {stretch:.4g}"


def bar_warnings(case: BarCase, time_step: float) -> list[str]:
    """Waves too short for the nodes, records in another unit, and dashpots at ends too soft for them."""
    finer = "" if case.method.carrying_horizon == 1 else " or method.horizon"
    warnings = [
        f"wave.{name}: has {cells:.3g} cells in its shortest wavelength, fewer than the {needed:.3g} that keep "
        f"the error of its speed under {PERCENT}; take a smaller bar.spacing{finer}"
        for name, (cells, needed) in cells_of_waves(case, time_step).items()
        if cells < needed
    ]
    warnings += [
        f"wave.{name}: its {wave.duration() - wave.start:g} s are longer than the run of {case.run.duration:g} s; "
        "are its file's times in s?"
        for name, wave in case.wave.items()
        if isinstance(wave, Record) and wave.duration() - wave.start > LONG * case.run.duration
    ]
    if not case.method.soft_ends:
        return warnings
    return warnings + [
        f"boundary.{side}: stands at a soft end of peridynamics and returns a part of every wave; "
        "give method.corrected_ends = true"
        for side, table in case.boundary.items()
        if isinstance(table, Dashpots)
    ]


def cells_of_waves(case: BarCase, time_step: float) -> dict[str, tuple[float, float]]:
    """Of every wave in use the cells in its shortest wavelength, and how many keep the error of its speed below ERROR.

    The shortest wavelength is that of the wave's highest frequency.
    """
    horizon = case.method.carrying_horizon
    courant = min(_courant(case, time_step), courant_limit(horizon))
    needed = cells_per_wavelength(horizon, courant, ERROR)
    spacing = case.bar.length / case.bar.cells
    fading = {name: wave.highest_frequency() for name, wave in case.wave.items() if name in _waves_used(case)}
    return {name: (case.bar.speed / (f * spacing) if f > 0.0 else np.inf, needed) for name, f in fading.items()}


def _waves_used(case: BarCase) -> set[str | None]:
    """Names of the waves that load the bar or enter at its ends."""
    driven = [end for end in case.boundary.values() if isinstance(end, Driven)]
    return {load.wave for load in case.load} | {end.wave_p for end in driven}


def _courant(case: BarCase, time_step: float) -> float:
    """Courant number ν = cΔt/Δx."""
    return time_step * case.bar.speed * case.bar.cells / case.bar.length

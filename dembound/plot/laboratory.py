"""Pictures of laboratory tests: those that are computed, and those on bars with gauges.

A computed test has curves of stress and strain, the sample as it breaks, and the envelope of strengths. A gauge on a
bar has its signal and the stress near the bar's free end (L figs 10 and 11), a split Hopkinson test the waves at the
faces of the specimen, its forces, strain rate and stress–strain curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.gauge.estimates import near_free_end
from dembound.gauge.gauge_io import Gauge
from dembound.gauge.hopkinson import Faces, Specimen
from dembound.gauge.spalling import Findings, Strength
from dembound.plot.field import Field, read_disks
from dembound.plot.field_reader import drawn_cracks
from dembound.plot.places import displacement_of
from dembound.plot.scene import draw_panel
from dembound.plot.style import COLOURS, REFERENCE, Powers, finished, line_style, new_figure, styled
from dembound.results.reader import open_record, snapshots_of
from dembound.results.recording import LoadingCurve, TestName

MEGA, MICRO = 1e6, 1e-6
"""Pascals in a megapascal, and seconds in a microsecond."""

STRESS: Mapping[TestName, str] = {
    "ucs": "axial stress, compression positive (MPa)",
    "biaxial": "axial stress, compression positive (MPa)",
    "tension": "axial stress, tension positive (MPa)",
    "brazilian": "tension 2P/(πD) in the middle (MPa)",
}
"""Label of the stress of each test."""

MOST_NAMED = 8
"""Largest number of curves that have a name in the legend."""

LARGEST = (3.4, 5.2)
"""Largest width and height of a sample on the page in inches."""

CALM, MARGIN = 0.98, 1.5
"""Share of the disks that have not broken off at the peak, and end of the colour scale over their largest motion."""


@styled
def plot_curves(title: str, curves: Mapping[str, LoadingCurve]) -> Figure:
    """Stress over the strain of the platens of all samples, and the number of broken bonds; first cracks are marked.

    Curves of one pressure at the sides have one colour, if there are several; else each sample has its own.
    """
    figure = new_figure(7.4, 5.4)
    panel = figure.subplots()
    broken = panel.twinx()
    pressures = sorted({curve.pressure for curve in curves.values()})
    named: set[str] = set()
    for number, (name, curve) in enumerate(curves.items()):
        if len(pressures) > 1:
            number, name = pressures.index(curve.pressure), f"{curve.pressure / MEGA:.3g} MPa at the sides"
        label = name if name not in named and len(named) < MOST_NAMED else None
        named.add(name)
        colour = COLOURS[number % len(COLOURS)]
        percent = 100.0 * curve.strain
        panel.plot(percent, curve.stress / MEGA, color=colour, label=label)
        if len(curve.crack_time):
            strain = np.interp(curve.crack_time, curve.time, percent)
            broken.step(strain, np.arange(1, len(strain) + 1), where="post", color=colour, linewidth=0.7, linestyle=":")
            looks: dict[str, Any] = {"color": colour, "markersize": 7.0, "markeredgecolor": "white"}
            looks["label"] = "first broken bond" if number == 0 else None
            panel.plot(strain[0], curve.first_crack / MEGA, "v", **looks)
    panel.set(xlabel="strain between the platens (%)", ylabel=STRESS[next(iter(curves.values())).kind])
    broken.set_ylabel("broken bonds (dotted)")
    broken.set_ylim(bottom=0.0)
    broken.grid(False)
    panel.set_ylim(bottom=0.0)
    panel.set_xlim(left=0.0)
    return finished(figure, title, [panel], 3)


@styled
def plot_sample(record: Path, curve: LoadingCurve) -> Figure:
    """A sample at its first crack, at its peak and at the end: motion across the cracks to come, and broken bonds.

    That is motion along y in tension, else along x.

    Raises CaseError when the record cannot be read.
    """
    states = {"peak": curve.time[curve.at_peak], "end": curve.time[-1]}
    if len(curve.crack_time):
        states = {"first crack": curve.crack_time[0]} | states
    with open_record(record) as file:
        disks, groups = read_disks(file), list(snapshots_of(file))
        axis = 1 if curve.kind == "tension" else 0
        nearest = [groups[int(np.argmin(np.abs(curve.gauge_time - time)))] for time in states.values()]
        motion = np.array([group["displacement"][:, axis] for group in nearest])
        limit = MARGIN * float(np.quantile(np.abs(motion[-2]), CALM)) or 1.0
        at_states = zip(states.values(), nearest, strict=True)
        cracks = [drawn_cracks(file, time, displacement_of(group), 0.0) for time, group in at_states]
    captions = [f"{name}, {curve.stress_at(time) / MEGA:.3g} MPa" for name, time in states.items()]
    shown = Field(captions, motion, cracks, (-limit, limit), f"displacement along {'xy'[axis]}", "m")
    width, height = disks.window.size
    scale = min(LARGEST[0] / width, LARGEST[1] / height)
    figure = new_figure(len(states) * (scale * width + 0.6) + 1.6, scale * height + 1.6)
    panels = figure.subplots(1, len(states), sharey=True, squeeze=False)[0]
    for number, panel in enumerate(panels):
        colours = draw_panel(panel, disks, shown, number, disks.window, scale * figure.dpi)
        panel.set_title(shown.captions[number])
        if number:
            panel.set_ylabel("")
    figure.colorbar(colours, ax=panels, label=shown.label, shrink=0.9, pad=0.02, format=Powers())
    return finished(figure, f"{disks.case}, {len(disks.radii):,} disks", panels, 2)


@styled
def plot_envelope(title: str, tests: Sequence[tuple[float, float]], angle: float, cohesion: float) -> Figure:
    """Mohr's circles of the mean strength at each pressure with the Mohr-Coulomb line, and the strengths themselves.

    Parameters
    ----------
    title
        of the picture.
    tests
        pressure at the sides and largest axial stress of each sample, Pa.
    angle, cohesion
        of the line, degrees and Pa.
    """
    pressure, strength = np.array(tests).T / MEGA
    figure = new_figure(9.6, 4.4)
    over, circles = figure.subplots(1, 2)
    sine = np.sin(np.radians(angle))
    slope = (1.0 + sine) / (1.0 - sine)
    uniaxial = 2.0 * cohesion / MEGA * np.sqrt(slope)
    ends = np.array([0.0, 1.05 * pressure.max()])
    over.plot(pressure, strength, "o", color=COLOURS[0], label="samples")
    over.plot(ends, uniaxial + slope * ends, color=COLOURS[1], label=f"{uniaxial:.3g} MPa + {slope:.3g}·pressure")
    over.set(xlabel="pressure at the sides (MPa)", ylabel="largest axial stress (MPa)")
    around = np.linspace(0.0, np.pi, 181)
    for number, each in enumerate(np.unique(pressure)):
        mean = float(strength[pressure == each].mean())
        middle, half = 0.5 * (each + mean), 0.5 * (mean - each)
        label = "mean strength at each pressure" if number == 0 else None
        circles.plot(middle + half * np.cos(around), half * np.sin(around), color=COLOURS[0], label=label)
    reach = np.array([0.0, 0.5 * (mean + each)])
    line = cohesion / MEGA + reach * np.tan(np.radians(angle))
    circles.plot(reach, line, color=COLOURS[1], label=f"φ = {angle:.3g}°, cohesion {cohesion / MEGA:.3g} MPa")
    circles.set(xlabel="normal stress, compression positive (MPa)", ylabel="shear stress (MPa)", aspect="equal")
    circles.set_xlim(0.0, 1.05 * strength.max())
    circles.set_ylim(0.0, 1.1 * max(0.5 * strength.max(), line.max()))
    return finished(figure, title, [over, circles], 2)


MEASURED = {"Pa": ("stress", "MPa", MEGA), "strain": ("strain", "µε", 1e-6), "V": ("signal", "V", 1.0)}
"""Unit of a gauge's signal -> its name, and the name and size of the unit in pictures."""

STEPS = (-1.5, -1.0, -0.5, 0.0, 0.5)
"""Times of the stresses near the free end, relative to the spall, in travel times from the spall to the end."""

PLACES = 500
"""Points of each line along the bar."""


@styled
def plot_gauge(gauge: Gauge, findings: Findings) -> Figure:
    """The history, with the tension peaks and their exponential fit if used; next to it the stress near the end.

    The stress near the end is drawn if the position of the spall is given: the incident pulse and its image at several
    times, without attenuation.

    Parameters
    ----------
    gauge, findings
        the gauge with its signal, and the estimates of `spalling.evaluate`.
    """
    figure = new_figure(10.0 if findings.strength else 7.0, 4.6)
    panels = figure.subplots(1, 2 if findings.strength else 1, squeeze=False)[0]
    _gauge_history(panels[0], gauge, findings)
    if findings.strength:
        _free_end(panels[1], gauge, findings.speed.value, findings.strength)
    return finished(figure, f"Gauge at {gauge.position:g} m of a bar of {gauge.length:g} m", panels, 3)


def _gauge_history(panel: Axes, gauge: Gauge, findings: Findings) -> None:
    """Stress, strain or voltage against time, its tension peaks, and the exponential through them."""
    peaks, decay = findings.peaks, findings.attenuation
    name, unit, size = MEASURED.get(gauge.unit, ("signal", "unit unknown", 1.0))
    panel.plot(1e3 * gauge.time, gauge.stress / size, color=REFERENCE, linewidth=1.0, label=f"{name} at the gauge")
    if peaks is not None and len(peaks.time):
        panel.plot(1e3 * peaks.time, peaks.height / size, "o", color=COLOURS[1], label="tension peaks")
    if peaks is not None and decay is not None and len(peaks.time) > 1:
        time = np.linspace(peaks.time[0], peaks.time[-1], PLACES)
        weights = peaks.height**2  # through the middle of the line that was fitted
        first, middle = (np.average(each, weights=weights) for each in (np.log(peaks.height), peaks.time))
        height = np.exp(first - decay.value * findings.speed.value * (time - middle))
        label = f"exp(−αct), α = {decay.value:.3g} 1/m, c = {findings.speed.value:.4g} m/s"
        panel.plot(1e3 * time, height / size, color=COLOURS[0], linestyle="--", label=label)
    panel.set(xlabel="time (ms)", ylabel=f"{name}, tension positive ({unit})")


def _free_end(panel: Axes, gauge: Gauge, speed: float, strength: Strength) -> None:
    """Stress along the last part of the bar at several times, and the largest tension where it spalled."""
    places = np.linspace(min(gauge.position, strength.position), gauge.length, PLACES)
    times = strength.time + np.array(STEPS) * (gauge.length - strength.position) / speed
    stresses = near_free_end(*strength.pulse, gauge.position, gauge.length, speed, places, times)
    for index, (time, stress) in enumerate(zip(times, stresses.T, strict=True)):
        looks: dict[str, Any] = line_style(index)
        panel.plot(places, stress / MEGA, label=f"at {1e3 * time:.3f} ms", **looks)
    label = f"largest tension at {strength.position:g} m: {strength.nominal / MEGA:.3g} MPa"
    panel.plot(strength.position, strength.nominal / MEGA, "*", color=COLOURS[-1], markersize=10, label=label)
    panel.axvline(strength.position, color=REFERENCE, linewidth=1.0, zorder=1)
    panel.set(xlabel="distance from the loaded end (m)", ylabel="stress, tension positive (MPa)")


@styled
def plot_hopkinson(faces: Faces, found: Specimen) -> Figure:
    """Four panels; the time in equilibrium is shaded, and the stress–strain curve is bold there.

    Parameters
    ----------
    faces, found
        waves at the faces by `hopkinson.at_faces`, and the specimen by `hopkinson.specimen`.
    """
    figure = new_figure(10.0, 7.2)
    waves, forces, rates, curve = figure.subplots(2, 2).ravel()
    time = found.time / MICRO
    passed = {"incident": faces.incident, "reflected": faces.reflected, "transmitted": faces.transmitted}
    for (name, values), colour in zip(passed.items(), COLOURS, strict=False):
        waves.plot(time, values / MICRO, color=colour, label=name)
    _label_history(waves, "strain of waves (µε, load positive)", found)
    forces.plot(time, found.front / MEGA, color=COLOURS[0], label="front, two waves")
    forces.plot(time, found.back / MEGA, color=COLOURS[1], linestyle="--", label="back, one wave")
    _label_history(forces, "stress at the faces (MPa)", found)
    rates.plot(time, found.rate, color=COLOURS[0], label="three waves")
    rates.plot(time, found.one_wave_rate, color=COLOURS[1], linestyle="--", label="one wave")
    _label_history(rates, "strain rate (1/s)", found)
    curve.plot(100.0 * found.strain, found.stress / MEGA, color=REFERENCE, label="three waves")
    balanced = np.where(found.in_equilibrium, 100.0 * found.strain, np.nan)
    curve.plot(balanced, found.stress / MEGA, color=COLOURS[0], linewidth=2.4, label="in equilibrium")
    curve.plot(100.0 * found.one_wave_strain, found.back / MEGA, color=COLOURS[1], linestyle="--", label="one wave")
    curve.set(xlabel="strain (%)", ylabel="stress (MPa)")
    curve.legend()
    figure.suptitle("Specimen in a split Hopkinson test; shaded: equilibrium of its forces", fontsize=11)
    return figure


def _label_history(panel: Axes, quantity: str, found: Specimen) -> None:
    """Axes of a history, and the shaded time in equilibrium."""
    if found.equilibrium is not None:
        first, end = found.equilibrium
        panel.axvspan(*(found.time[[first, end - 1]] / MICRO), color="#D3E2F0")
    panel.set(xlabel="time since the pulse has reached the specimen (µs)", ylabel=quantity)
    panel.legend()

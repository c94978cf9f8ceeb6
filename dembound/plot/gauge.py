"""The signal of a gauge on a bar, and the stress near the bar's free end (L figs 10 and 11)."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.gauge.estimates import near_free_end
from dembound.gauge.gauge_io import Gauge
from dembound.gauge.spalling import Findings, Strength
from dembound.plot.style import COLOURS, REFERENCE, finished, line_style, new_figure, styled

MPA = 1e6
"""Pascals in a megapascal."""

MEASURED = {"Pa": ("stress", "MPa", MPA), "strain": ("strain", "µε", 1e-6), "V": ("signal", "V", 1.0)}
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
    _history(panels[0], gauge, findings)
    if findings.strength:
        _free_end(panels[1], gauge, findings.speed.value, findings.strength)
    return finished(figure, f"Gauge at {gauge.position:g} m of a bar of {gauge.length:g} m", panels, 3)


def _history(panel: Axes, gauge: Gauge, findings: Findings) -> None:
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
    panel.set_xlabel("time (ms)")
    panel.set_ylabel(f"{name}, tension positive ({unit})")


def _free_end(panel: Axes, gauge: Gauge, speed: float, strength: Strength) -> None:
    """Stress along the last part of the bar at several times, and the largest tension where it spalled."""
    places = np.linspace(min(gauge.position, strength.position), gauge.length, PLACES)
    times = strength.time + np.array(STEPS) * (gauge.length - strength.position) / speed
    stresses = near_free_end(*strength.pulse, gauge.position, gauge.length, speed, places, times)
    for index, (time, stress) in enumerate(zip(times, stresses.T, strict=True)):
        looks: dict[str, Any] = line_style(index)
        panel.plot(places, stress / MPA, label=f"at {1e3 * time:.3f} ms", **looks)
    label = f"largest tension at {strength.position:g} m: {strength.nominal / MPA:.3g} MPa"
    panel.plot(strength.position, strength.nominal / MPA, "*", color=COLOURS[-1], markersize=10, label=label)
    panel.axvline(strength.position, color=REFERENCE, linewidth=1.0, zorder=1)
    panel.set_xlabel("distance from the loaded end (m)")
    panel.set_ylabel("stress, tension positive (MPa)")

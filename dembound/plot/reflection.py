"""Reflection of P and S waves by a side, against angle and against frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from dembound.plot.style import COLOURS, DASHES, finished, line_style, new_figure, styled

LEAST = 1e-6
"""Smallest share of energy drawn: 0.1 % of the amplitude."""

SHOWN = (0.0, 30.0, 60.0)
"""Angles (degrees) for which shares are drawn against frequency, or the nearest ones that were computed."""

GREYS = ("#000000", "#606060", "#A8A8A8")
"""Colours of lines against frequency: lines against angle have the other colours."""


class Curves(NamedTuple):
    """Shares of reflected energy for one type of incident waves.

    name : of the waves. same, converted : (f, a) shares reflected as the same and as the other type. beside : name ->
    total (f, a) of other sides for comparison.
    """

    name: str
    same: np.ndarray
    converted: np.ndarray
    beside: Mapping[str, np.ndarray]


@styled
def plot_reflection(angles: np.ndarray, frequencies: np.ndarray, waves: Sequence[Curves], title: str) -> Figure:
    """Means over frequencies, and their range, against angle (above); against frequency at some angles (below).

    Parameters
    ----------
    angles, frequencies
        (a,) degrees from the normal of the side, (f,) Hz.
    waves
        the types of waves, a column of panels for each.
    title
        of the figure.
    """
    figure = new_figure(5.2 * len(waves), 7.6)
    panels = figure.subplots(2, len(waves), squeeze=False, sharey=True)
    for (upper, lower), each in zip(panels.T, waves, strict=True):
        _against_angle(upper, angles, each)
        _against_frequency(lower, angles, frequencies, each)
        upper.set_title(f"incident {each.name} waves")
    for panel in panels[:, 0]:
        panel.set_ylabel("energy sent back / incident (–)")
    return finished(figure, title, list(panels.ravel()), 3)


@styled
def plot_types(
    frequencies: np.ndarray,
    waves: Mapping[str, Mapping[str, tuple[np.ndarray, np.ndarray]]],
    spectra: Mapping[str, np.ndarray],
    title: str,
) -> Figure:
    """What types of a side return against frequency, a column for each type of incident waves.

    Parameters
    ----------
    frequencies
        (f,) Hz.
    waves
        type of waves -> name of the side's type -> angles (a,), degrees, and shares (f, a) of energy.
    spectra
        type of waves -> (f,) velocity amplitudes of the waves over the largest, drawn as areas.
    title
        of the figure.
    """
    figure = new_figure(5.6 * len(waves), 4.8)
    panels = figure.subplots(1, len(waves), squeeze=False, sharey=True)[0]
    for panel, (kind, types) in zip(panels, waves.items(), strict=True):
        for number, (name, (angles, shares)) in enumerate(types.items()):
            for index, angle in enumerate(angles):
                colour, dash = COLOURS[number % len(COLOURS)], DASHES[index % len(DASHES)]
                line = f"{name}, {angle:g}°"
                look: dict[str, Any] = {"color": colour, "linestyle": dash, "label": line, "gid": f"{kind}, {line}"}
                panel.plot(frequencies, _drawn(shares[:, index]), **look)
        panel.set(title=f"incident {kind} waves", xlabel="frequency (Hz)", xscale="log")
        _log(panel)
        if kind in spectra:
            behind = panel.twinx()
            behind.fill_between(frequencies, spectra[kind], color="#E8E8E8", linewidth=0.0)
            behind.set(ylabel="amplitude of the wave / largest (–), grey", yscale="log", ylim=(1e-3, 1.3))
            behind.yaxis.set_minor_locator(NullLocator())
            behind.grid(visible=False)
            panel.set_zorder(behind.get_zorder() + 1)
            panel.patch.set_visible(False)
    panels[0].set_ylabel("energy sent back / incident (–)")
    return finished(figure, title, list(panels), 2)


def _against_angle(panel: Axes, angles: np.ndarray, each: Curves) -> None:
    """Means and range over frequencies."""
    total = each.same + each.converted
    low, high = np.nanmin(total, axis=0), np.nanmax(total, axis=0)
    panel.fill_between(
        angles, _drawn(low), _drawn(high), color=COLOURS[0], alpha=0.2, linewidth=0.0, label="range over frequencies"
    )
    for number, (name, values) in enumerate(
        {"in all": total, "as the same type": each.same, "as the other type": each.converted, **each.beside}.items()
    ):
        look: dict[str, Any] = dict(line_style(number))
        panel.plot(angles, _drawn(np.nanmean(values, axis=0)), label=name, gid=f"{each.name}, {name}", **look)
    panel.set_xlabel("angle from the normal (°)")
    _log(panel)
    panel.set_xlim(angles.min(), max(angles.max(), angles.min() + 1.0))


def _against_frequency(panel: Axes, angles: np.ndarray, frequencies: np.ndarray, each: Curves) -> None:
    """Draw the total against frequency, at some angles."""
    near = dict.fromkeys(int(np.argmin(np.abs(angles - angle))) for angle in SHOWN)
    for index, colour, dash in zip(near, GREYS, DASHES, strict=False):
        values, name = (each.same + each.converted)[:, index], f"in all at {angles[index]:g}°"
        look: dict[str, Any] = {"color": colour, "linestyle": dash, "marker": "o", "markersize": 3.0}
        panel.plot(frequencies, _drawn(values), label=name, gid=f"{each.name}, {name}", **look)
    panel.set_xlabel("frequency (Hz)")
    _log(panel)


def _log(panel: Axes) -> None:
    """Shares on a logarithmic axis, without minor ticks, whose layout takes as long as all else."""
    panel.set_yscale("log")
    panel.yaxis.set_minor_locator(NullLocator())
    panel.set_ylim(LEAST, 1.3)


def _drawn(values: np.ndarray) -> np.ndarray:
    """Shares clipped to the axis."""
    return np.maximum(values, LEAST)

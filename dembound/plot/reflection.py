"""Plane waves: what a side reflects, by angle and frequency, and wave speeds on the nodes of bars (L fig. 5)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator, ScalarFormatter

from dembound.exact.bar import Lattice
from dembound.plot.style import COLOURS, DASHES, REFERENCE, finished, line_style, new_figure, point_style, styled

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
    return finished(figure, title, panels.flat, 3)


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
                panel.plot(frequencies, np.maximum(shares[:, index], LEAST), **look)
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
    ends = np.maximum(low, LEAST), np.maximum(high, LEAST)
    panel.fill_between(angles, *ends, color=COLOURS[0], alpha=0.2, linewidth=0.0, label="range over frequencies")
    shares = {"in all": total, "as the same type": each.same, "as the other type": each.converted, **each.beside}
    for number, (name, values) in enumerate(shares.items()):
        look: dict[str, Any] = {"label": name, "gid": f"{each.name}, {name}", **line_style(number)}
        panel.plot(angles, np.maximum(np.nanmean(values, axis=0), LEAST), **look)
    panel.set_xlabel("angle from the normal (°)")
    _log(panel)
    panel.set_xlim(angles.min(), max(angles.max(), angles.min() + 1.0))


def _against_frequency(panel: Axes, angles: np.ndarray, frequencies: np.ndarray, each: Curves) -> None:
    """Draw the total against frequency, at some angles."""
    near = dict.fromkeys(int(np.argmin(np.abs(angles - angle))) for angle in SHOWN)
    for index, colour, dash in zip(near, GREYS, DASHES, strict=False):
        values, name = (each.same + each.converted)[:, index], f"in all at {angles[index]:g}°"
        look: dict[str, Any] = {"color": colour, "linestyle": dash, "marker": "o", "markersize": 3.0}
        panel.plot(frequencies, np.maximum(values, LEAST), label=name, gid=f"{each.name}, {name}", **look)
    panel.set_xlabel("frequency (Hz)")
    _log(panel)


def _log(panel: Axes) -> None:
    """Shares on a logarithmic axis, without minor ticks, whose layout takes as long as all else."""
    panel.set_yscale("log")
    panel.yaxis.set_minor_locator(NullLocator())
    panel.set_ylim(LEAST, 1.3)


CELLS = np.geomspace(2.0, 100.0, 800)
"""Range of spacings per wavelength, up to where wide horizons are exact to a few per cent."""

WIDTH, WIDENED = 1.4, 2.0
"""Width (points) of a line over spacings per wavelength, and additional width for each line of the same horizon above.

These nearly coincide, and each must be visible below the next.
"""

TICKS = (2, 3, 5, 10, 20, 50, 100)

Points = tuple[np.ndarray, np.ndarray]
"""Wave numbers (k,) rad/m and the angular frequencies (k,) rad/s found there."""


@styled
def plot_dispersion(lattices: Sequence[Lattice], measured: Sequence[Points] = ()) -> Figure:
    """Frequency against wave number, and the speeds of crests and of energy against spacings per wavelength.

    Parameters
    ----------
    lattices
        Rows of nodes; the line of each ends at its shortest wave, or where waves become unstable.
    measured
        Results of simulations of these lattices, one pair each in the same order; none: lines only.
    """
    figure = new_figure(11.0, 4.4)
    left, middle, right = figure.subplots(1, 3)
    horizons = [lattice.horizon for lattice in lattices]
    for index, lattice in enumerate(lattices):
        style: dict[str, Any] = dict(line_style(index))
        wavenumber = np.linspace(0.0, lattice.shortest, 800)
        left.plot(wavenumber, _kilohertz(lattice.frequency(wavenumber)), label=name(lattice), **style)
        style["linewidth"] = WIDTH + WIDENED * horizons[index + 1 :].count(lattice.horizon)
        wavenumber = 2.0 * lattice.shortest / CELLS
        middle.plot(CELLS, lattice.phase_velocity(wavenumber) / lattice.wave_speed, **style)
        right.plot(CELLS, lattice.group_velocity(wavenumber) / lattice.wave_speed, **style)
    for index, (lattice, (wavenumber, frequency)) in enumerate(zip(lattices, measured, strict=False)):
        markers = {**point_style(index), "linestyle": "none"}
        left.plot(wavenumber, _kilohertz(frequency), label="simulated", **markers)
        middle.plot(2.0 * lattice.shortest / wavenumber, frequency / (wavenumber * lattice.wave_speed), **markers)
    _exact_lines(left, lattices)
    for panel, quantity in ((middle, "phase velocity ω/k / c (–)"), (right, "group velocity dω/dk / c (–)")):
        panel.axhline(1.0, color=REFERENCE, linewidth=1.0, zorder=1)
        panel.set(xscale="log", xlim=(CELLS[0], CELLS[-1]), xticks=TICKS, ylim=(0.0, 1.15))
        panel.xaxis.set_major_formatter(ScalarFormatter())
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.set(xlabel="spacings per wavelength (–)", ylabel=quantity)
    return finished(figure, "Dispersion of a bar of nodes; a horizon of 1 spacing is central differences", [left], 3)


def name(lattice: Lattice) -> str:
    """A lattice in words, such as "horizon 3, Δx = 5 mm, Δt = 1 µs"."""
    step = f"Δt = {1e6 * lattice.time_step:g} µs" if lattice.time_step else "exact in time"
    unstable = "" if lattice.stable else ", unstable"
    return f"horizon {horizon_in_words(lattice)}, Δx = {1e3 * lattice.spacing:.4g} mm, {step}{unstable}"


def horizon_in_words(lattice: Lattice) -> str:
    """The horizon of a lattice in words; shares of the stress that differ from L's follow in brackets."""
    shares = "" if lattice.shares is None else f" ({'/'.join(f'{share:.3g}' for share in lattice.shares)})"
    return f"{lattice.horizon}{shares}"


def _exact_lines(panel: Axes, lattices: Sequence[Lattice]) -> None:
    """Frequencies kc/2π of a bar without nodes, up to the largest of the lattices."""
    ends = np.array([0.0, max(lattice.shortest for lattice in lattices)])
    highest = max(np.nanmax(lattice.frequency(np.linspace(0.0, lattice.shortest, 100))) for lattice in lattices)
    for speed in sorted({lattice.wave_speed for lattice in lattices}):
        label = f"no dispersion, c = {speed:g} m/s"
        panel.plot(ends, _kilohertz(speed * ends), color=REFERENCE, linewidth=1.0, zorder=1, label=label)
    panel.set(xlim=(0.0, ends[1]), ylim=(0.0, 1.1 * float(_kilohertz(highest))))
    panel.set(xlabel="wave number k (rad/m)", ylabel="frequency ω/2π (kHz)")


def _kilohertz(frequency: np.ndarray | float) -> np.ndarray:
    """Frequencies in kHz from rad/s."""
    return np.asarray(frequency) / (2e3 * np.pi)

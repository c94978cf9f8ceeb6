"""Wave speeds on the nodes of a bar, for several lattices in one figure (L fig. 5)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, ScalarFormatter

from dembound.exact.dispersion import Lattice
from dembound.plot.style import REFERENCE, finished, line_style, new_figure, point_style, styled

CELLS = np.geomspace(2.0, 100.0, 800)
"""Range of spacings per wavelength, up to where wide horizons are exact to a few per cent."""

WIDTH, WIDENED = 1.4, 2.0
"""Width of a line in points, and the additional width for each further line of the same horizon above it."""

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
    widths = line_widths(lattices)
    for index, lattice in enumerate(lattices):
        style: dict[str, Any] = dict(line_style(index))
        wavenumber = np.linspace(0.0, lattice.shortest, 800)
        left.plot(wavenumber, _kilohertz(lattice.frequency(wavenumber)), label=name(lattice), **style)
        style["linewidth"] = widths[index]
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
        _cells_axis(panel)
        panel.set_ylabel(quantity)
    return finished(figure, "Dispersion of a bar of nodes; a horizon of 1 spacing is central differences", [left], 3)


def line_widths(lattices: Sequence[Lattice]) -> list[float]:
    """Line widths in points over spacings per wavelength, larger where more lattices of the same horizon follow.

    The lines nearly coincide there, and each must be visible below the next.
    """
    horizons = [lattice.horizon for lattice in lattices]
    return [WIDTH + WIDENED * horizons[index + 1 :].count(horizon) for index, horizon in enumerate(horizons)]


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
    panel.set_xlim(0.0, ends[1])
    panel.set_ylim(0.0, 1.1 * float(_kilohertz(highest)))
    panel.set_xlabel("wave number k (rad/m)")
    panel.set_ylabel("frequency ω/2π (kHz)")


def _cells_axis(panel: Axes) -> None:
    """Spacings per wavelength, long waves to the right."""
    panel.set_xscale("log")
    panel.set_xlim(CELLS[0], CELLS[-1])
    panel.set_xticks(TICKS)
    panel.xaxis.set_major_formatter(ScalarFormatter())
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set_ylim(0.0, 1.15)
    panel.set_xlabel("spacings per wavelength (–)")


def _kilohertz(frequency: np.ndarray | float) -> np.ndarray:
    """Frequencies in kHz from rad/s."""
    return np.asarray(frequency) / (2e3 * np.pi)

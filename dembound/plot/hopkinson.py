"""A split Hopkinson test: the waves at the faces of the specimen, its forces, strain rate and stress–strain curve."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.gauge.hopkinson import Faces, Specimen
from dembound.plot.style import COLOURS, REFERENCE, new_figure, styled

MPA, MICRO = 1e6, 1e-6
"""Pascals in a megapascal, and seconds in a microsecond."""


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
    _labelled(waves, "strain of waves (µε, load positive)", found)
    forces.plot(time, found.front / MPA, color=COLOURS[0], label="front, two waves")
    forces.plot(time, found.back / MPA, color=COLOURS[1], linestyle="--", label="back, one wave")
    _labelled(forces, "stress at the faces (MPa)", found)
    rates.plot(time, found.rate, color=COLOURS[0], label="three waves")
    rates.plot(time, found.one_wave_rate, color=COLOURS[1], linestyle="--", label="one wave")
    _labelled(rates, "strain rate (1/s)", found)
    curve.plot(100.0 * found.strain, found.stress / MPA, color=REFERENCE, label="three waves")
    there = found.in_equilibrium
    curve.plot(
        np.where(there, 100.0 * found.strain, np.nan),
        found.stress / MPA,
        color=COLOURS[0],
        linewidth=2.4,
        label="in equilibrium",
    )
    curve.plot(100.0 * found.one_wave_strain, found.back / MPA, color=COLOURS[1], linestyle="--", label="one wave")
    curve.set_xlabel("strain (%)")
    curve.set_ylabel("stress (MPa)")
    curve.legend()
    figure.suptitle("Specimen in a split Hopkinson test; shaded: equilibrium of its forces", fontsize=11)
    return figure


def _labelled(panel: Axes, quantity: str, found: Specimen) -> None:
    """Axes of a history, and the shaded time in equilibrium."""
    if found.equilibrium is not None:
        first, end = found.equilibrium
        panel.axvspan(*(found.time[[first, end - 1]] / MICRO), color="#D3E2F0")
    panel.set_xlabel("time since the pulse has reached the specimen (µs)")
    panel.set_ylabel(quantity)
    panel.legend()

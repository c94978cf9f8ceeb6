"""A measured ground motion: its histories and its spectra, a column for each component."""

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
from matplotlib.figure import Figure

from dembound.plot.spectra import LEGEND_OF_FAINT, draw_curve, fourier_curve, on_logarithmic_axes, response_curve
from dembound.plot.style import line_style, new_figure, styled
from dembound.records.processing import Motion
from dembound.spectra.response import FEWEST_PER_PERIOD

LABELS = (
    "acceleration\n(m/s²)",
    "velocity\n(m/s)",
    "displacement\n(m)",
    "Fourier amplitude of\nthe acceleration (m/s)",
    "pseudo-acceleration,\n5 % damping (m/s²)",
)
"""Axes of the rows: three histories, two spectra."""

HISTORIES = 3
"""Rows of histories."""

HIGHEST = 100.0
"""Largest amplitude of transfer functions that is shown: undamped ground stands still within at some frequencies."""


@styled
def plot_motions(motions: Sequence[Motion], title: str) -> Figure:
    """Acceleration, velocity, displacement, Fourier and response spectrum of components, with common axes in a row."""
    figure = new_figure(2.5 + 4.0 * len(motions), 9.5)
    panels = figure.subplots(len(LABELS), len(motions), sharey="row", squeeze=False)
    for first, *others in (panels[:HISTORIES].flat, *panels[HISTORIES:]):
        for panel in others:
            panel.sharex(first)
    for column, motion in zip(panels.T, motions, strict=True):
        name, look = motion.component or "motion", line_style(0)
        for panel, values in zip(column, (motion.acceleration, motion.velocity, motion.displacement), strict=False):
            panel.plot(motion.time, values, gid=name, **look | {"linewidth": 0.7})
        base = motion.acceleration, motion.time_step
        for panel, curve in zip(
            column[HISTORIES:], (fourier_curve(*base), response_curve(*base, FEWEST_PER_PERIOD)), strict=True
        ):
            draw_curve(panel, curve, name, name, look)
        for panel in column[: HISTORIES - 1]:
            panel.tick_params(labelbottom=False)
        for panel, along in zip(column[HISTORIES - 1 :], ("time (s)", "frequency (Hz)", "period (s)"), strict=True):
            panel.set_xlabel(along)
        column[0].set_title(name)
    for panel, label in zip(panels[:, 0], LABELS, strict=True):
        panel.set_ylabel(label)
    panels[HISTORIES, -1].plot([], [], **LEGEND_OF_FAINT)
    panels[HISTORIES, -1].legend(
        *([each[-1:] for each in panels[HISTORIES, -1].get_legend_handles_labels()]), loc="lower center", fontsize=8
    )
    for row in panels[HISTORIES:]:
        on_logarithmic_axes(row)
    figure.suptitle(title, fontsize=11)
    return figure


@styled
def plot_transfers(
    transfers: Mapping[Literal["p", "s"], tuple[np.ndarray, Mapping[str, Mapping[str, np.ndarray]]]], title: str
) -> Figure:
    """Amplitudes of transfer functions to the surface, a row for each input, a column for each kind of wave.

    transfers : by kind, "s" or "p": frequencies (k,) Hz, and by input and by curve |surface over input| (k,).
    """
    figure = new_figure(2.5 + 5.0 * len(transfers), 6.5)
    panels = figure.subplots(2, len(transfers), sharex="col", sharey="row", squeeze=False)
    for column, (kind, (frequencies, inputs)) in zip(panels.T, transfers.items(), strict=True):
        for panel, (over, curves) in zip(column, inputs.items(), strict=True):
            for number, (name, amplitude) in enumerate(curves.items()):
                look = line_style(number) | {"linewidth": 1.0}
                panel.plot(frequencies, amplitude, label=name, gid=f"{kind.upper()} waves over {over}", **look)
            panels[list(inputs).index(over), 0].set_ylabel(f"surface over {over}, amplitude (–)")
            panel.set_yscale("log")
            panel.yaxis.set_major_formatter("{x:g}")
            panel.yaxis.set_minor_formatter("{x:g}")
            panel.set_ylim(top=min(panel.get_ylim()[1], HIGHEST))
        column[0].set_title(f"{kind.upper()} waves")
        column[0].legend(fontsize=8)
        column[-1].set_xlabel("frequency (Hz)")
    figure.suptitle(title, fontsize=11)
    return figure

"""A measured ground motion, and amplitude spectra of velocities on linear axes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.figure import Figure

from dembound.plot.histories import chosen_monitors, direction, largest_values, left_out, those, title_monitors
from dembound.plot.spectra import LEGEND_OF_FAINT, draw_curve, fourier_curve, on_logarithmic_axes, response_curve
from dembound.plot.style import Powers, finished, line_style, measured_once, new_figure, stacked_height, styled
from dembound.records.processing import Motion
from dembound.results.histories import read_histories
from dembound.results.reader import COMPONENTS, record_names
from dembound.spectra import FEWEST_PER_PERIOD
from dembound.waves.wave import FADED, amplitude_spectrum

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
        draw_curve(column[-2], fourier_curve(*base), name, name, look)
        draw_curve(column[-1], response_curve(*base, FEWEST_PER_PERIOD), name, name, look)
        for panel in column[: HISTORIES - 1]:
            panel.tick_params(labelbottom=False)
        for panel, along in zip(column[HISTORIES - 1 :], ("time (s)", "frequency (Hz)", "period (s)"), strict=True):
            panel.set_xlabel(along)
        column[0].set_title(name)
    for panel, label in zip(panels[:, 0], LABELS, strict=True):
        panel.set_ylabel(label)
    faint = panels[HISTORIES, -1].plot([], [], **LEGEND_OF_FAINT)
    panels[HISTORIES, -1].legend(handles=faint, loc="lower center", fontsize=8)
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


FEWEST = 4
"""Least number of samples of a history for a spectrum."""


@styled
def plot_spectra(runs: Sequence[Path], component: Literal["x", "y"] | None = None) -> Figure:
    """Amplitude spectra |∫ v exp(−2πift) dt| of the velocities at the monitors, one panel each, with common axes.

    Frequencies end where all spectra are below 1 % of the largest value. For a motion that is not over at the
    end of the run the spectrum is that of the recorded part. A monitor at rest, or with a velocity that is not finite,
    has an empty panel.

    Parameters
    ----------
    runs
        ``run.h5`` files; a monitor need not occur in all of them.
    component
        by default x or y, whichever is larger in any run.

    Raises CaseError when a file cannot be read or no run has a monitor.
    """
    histories = [read_histories(path, "velocity") for path in runs]
    shown = chosen_monitors(runs, histories, None)
    drawn = those(histories, shown)
    column = int(np.argmax(largest_values(drawn))) if component is None else COMPONENTS.index(component)
    figure = new_figure(9.0, stacked_height(len(shown)))
    panels = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)
    spectra: list[tuple[np.ndarray, np.ndarray]] = []
    for index, (label, run) in enumerate(zip(record_names(runs), drawn, strict=True)):
        for name, history in run.items():
            if len(history.time) < FEWEST or not history.values[:, column].any():
                continue
            # at equal intervals, as the last one of a run may be shorter than all others
            time = np.linspace(history.time[0], history.time[-1], len(history.time))
            values = np.interp(time, history.time, history.values[:, column])
            frequencies, amplitudes = amplitude_spectrum(values, time[1] - time[0])
            spectra.append((frequencies, amplitudes))
            panels[shown.index(name), 0].plot(frequencies, amplitudes, label=label, gid=name, **line_style(index))
    title_monitors(panels, shown, drawn)
    for panel in panels[:, 0]:
        panel.yaxis.set_major_formatter(Powers())
    least = FADED * max((amplitudes.max() for _, amplitudes in spectra), default=0.0)
    ends = [frequencies[amplitudes >= least].max(initial=0.0) for frequencies, amplitudes in spectra]
    panels[-1, 0].set(xlabel="frequency (Hz)", xlim=(0.0, float(max(ends, default=1.0))), ylim=(0.0, None))
    figure.supylabel("amplitude (m/s per Hz)", fontsize=10)
    measured_once(panels)
    title = f"Spectra of the velocity {direction(column)} at the monitors{left_out(shown, histories, None)}"
    return finished(figure, title, panels.flat, 3)

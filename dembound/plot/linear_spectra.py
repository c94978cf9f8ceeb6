"""Amplitude spectra of the velocities at the monitors on linear axes, for pages."""

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.figure import Figure

from dembound.plot.histories import chosen_monitors, direction, largest_values, monitor_title
from dembound.plot.style import Powers, line_style, measured_once, new_figure, outside_legend, stacked_height, styled
from dembound.results.histories import MonitorRecord, read_histories
from dembound.results.reader import COMPONENTS, record_names
from dembound.waves.spectrum import FADED, amplitude_spectrum

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
    drawn = [{name: run[name] for name in shown if name in run} for run in histories]
    column = int(np.argmax(largest_values(drawn))) if component is None else COMPONENTS.index(component)
    height = stacked_height(len(shown))
    figure = new_figure(9.0, height)
    panels = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)
    spectra = []
    for index, (label, run) in enumerate(zip(record_names(runs), drawn, strict=True)):
        for name, history in run.items():
            values = history.values[:, column]
            if len(values) < FEWEST or not values.any():
                continue
            frequencies, amplitudes = spectrum_of(history, column)
            spectra.append((frequencies, amplitudes))
            panels[shown.index(name), 0].plot(frequencies, amplitudes, label=label, gid=name, **line_style(index))
    for panel, monitor in zip(panels[:, 0], shown, strict=True):
        title = monitor_title(monitor, [run[monitor] for run in drawn if monitor in run])
        panel.set_title(title, loc="left", fontsize=9, pad=3)
        panel.yaxis.set_major_formatter(Powers())
    panels[-1, 0].set_xlabel("frequency (Hz)")
    panels[-1, 0].set(xlim=(0.0, _end_of(spectra)), ylim=(0.0, None))
    figure.supylabel("amplitude (m/s per Hz)", fontsize=10)
    figure.suptitle(f"Spectra of the velocity {direction(column)} at the monitors", fontsize=11)
    measured_once(panels)
    outside_legend(figure, panels.flat, columns=3)
    return figure


def spectrum_of(history: MonitorRecord, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (m,), Hz, and amplitudes (m,), m/s per Hz, of a component of a velocity.

    As the last interval of a run may be shorter than all others, samples are interpolated at equal intervals.
    """
    time = np.linspace(history.time[0], history.time[-1], len(history.time))
    values = np.interp(time, history.time, history.values[:, column])
    return amplitude_spectrum(values, time[1] - time[0])


def _end_of(spectra: Sequence[tuple[np.ndarray, np.ndarray]]) -> float:
    """The frequency (Hz) above which all spectra are negligible relative to the largest value; 1 without any."""
    least = FADED * max((amplitudes.max() for _, amplitudes in spectra), default=0.0)
    return max(
        (float(frequencies[amplitudes >= least].max(initial=0.0)) for frequencies, amplitudes in spectra), default=1.0
    )

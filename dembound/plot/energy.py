"""Where the energy of a run is, where it went, and how well its books close."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.plot.style import REFERENCE, line_style, new_figure, outside_legend, styled
from dembound.results import energy_of, open_record

COLUMNS = {
    "outside": "in: boundaries and driven loads",
    "load": "in: steady loads",
    "kinetic": "kinetic",
    "contact": "stored in contacts",
    "bond": "stored in bonds",
    "damping": "taken by local damping",
    "friction": "taken by friction",
    "crack": "taken by cracks",
}
"""Columns of the ledger and what the legend calls them."""


@styled
def plot_energy(run: Path) -> Figure:
    """The energy ledger of a run against time; below, its error in parts of the most that came in.

    What stays zero all through the run is left out.

    Parameters
    ----------
    run
        the ``run.h5`` of a complete run.

    Raises CaseError when the file cannot be read or has no ledger.
    """
    with open_record(run) as file:
        name, columns = str(file.attrs["name"]), energy_of(file)
    figure = new_figure(9.0, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[4, 1])
    for index, (column, label) in enumerate(COLUMNS.items()):
        if np.any(columns[column]):
            upper.plot(columns["time"], columns[column], label=label, **line_style(index))
    lower.plot(columns["time"], columns["relative_error"], color=REFERENCE)
    upper.set_ylabel("energy (J per metre of thickness)")
    lower.set_ylabel("error (–)")
    lower.set_xlabel("time (s)")
    lower.set_title("error of the balance, in parts of the most that came in", loc="left", fontsize=9, pad=3)
    figure.suptitle(f"{name}: where its energy is, and where it went", fontsize=11)
    outside_legend(figure, [upper], columns=3)
    return figure

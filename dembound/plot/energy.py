"""Stored, supplied and dissipated energy of a run, and the error of its balance."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, MaxNLocator, StrMethodFormatter

from dembound.plot.style import COLOURS, REFERENCE, line_style, new_figure, outside_legend, styled, time_unit
from dembound.results.reader import energy_of, is_line, open_record, text_of

COLUMNS = {
    "outside": "in: boundaries and driven loads",
    "load": "in: steady loads",
    "balance": "in: forces that balance the settled stress",
    "kinetic": "kinetic",
    "contact": "stored in contacts",
    "bond": "stored in bonds",
    "damping": "taken by local damping",
    "friction": "taken by friction",
    "crack": "taken by cracks",
    "law_switch": "in: added by a change of law",
}
"""Columns of the ledger and their names in the legend."""

BAR_COLUMNS = COLUMNS | {
    "outside": "in: ends and loads",
    "contact": "stored in local springs",
    "bond": "stored in peridynamic bonds",
    "damping": "taken by attenuation",
    "law_switch": "in: added by a change of method",
}
"""The same for a bar."""

HUES = (*COLOURS, "#8C510A", "#999999", "#5E3C99")
"""A colour for each of them."""

OWN_LOOKS: dict[str, dict[str, Any]] = {
    "contact": {"linewidth": 4.0, "alpha": 0.7, "zorder": 1.9},
    "kinetic": {"zorder": 2.1},
}
"""Energies of contacts and bonds are often equal, so the one is a thin line above the wide line of the other."""

NEGLIGIBLE = 1e-6
"""A column that stays below this share of the largest is left out."""


@styled
def plot_energy(run: Path) -> Figure:
    """The energy ledger of a run against time; below, its error over the supplied energy.

    Columns that are negligible during the whole run are left out, as are those that an earlier version did not write.

    Parameters
    ----------
    run
        the ``run.h5`` of a complete run.

    Raises CaseError when the file cannot be read or has no ledger.
    """
    with open_record(run) as file:
        name, columns, bar = text_of(file.attrs["name"]), energy_of(file), is_line(file.attrs["size"])
    unit = time_unit(columns["time"][-1])
    time = columns["time"] / unit.seconds
    figure = new_figure(9.0, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[4, 1])
    largest = {column: float(np.abs(columns[column]).max()) for column in COLUMNS if column in columns}
    least = NEGLIGIBLE * max(largest.values())
    for index, (column, label) in enumerate((BAR_COLUMNS if bar else COLUMNS).items()):
        if largest.get(column, 0.0) > least:
            looks = line_style(index) | {"color": HUES[index]} | OWN_LOOKS.get(column, {})
            upper.plot(time, columns[column], label=label, gid=label, **looks)
    lower.plot(time, columns["relative_error"], color=REFERENCE, gid="error of the balance")
    lower.yaxis.set_major_locator(MaxNLocator(nbins=3))
    lower.yaxis.set_major_formatter(StrMethodFormatter("{x:.3g}"))  # each with its own power, none next to the title
    upper.set_ylabel("energy (J)" if bar else "energy per metre of thickness (J/m)")
    upper.yaxis.set_major_formatter(EngFormatter())
    lower.set_ylabel("error (–)")
    lower.set_xlabel(unit.label)
    lower.set_title("error of the balance, in parts of the most that came in", loc="left", fontsize=9, pad=3)
    figure.suptitle(f"{name}: where its energy is, and where it went", fontsize=11)
    outside_legend(figure, [upper], columns=3)
    return figure

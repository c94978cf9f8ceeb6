"""Stored, supplied and dissipated energy of a run, and the error of its balance."""

from collections.abc import Iterator
from math import floor, log10
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, StrMethodFormatter

from dembound.plot.style import COLOURS, REFERENCE, Powers, finished, line_style, new_figure, styled, time_unit
from dembound.results.reader import energy_of, is_line, open_record, side_energies_of, text_of

COLUMNS = {
    "outside": "supplied, net: boundaries and driven loads",
    "loads": "supplied: driven loads",
    "load": "supplied: steady loads",
    "balance": "supplied: forces that hold the settled state",
    "kinetic": "stored: kinetic",
    "contact": "stored: elastic, contacts",
    "bond": "stored: elastic, bonds",
    "damping": "dissipated: damping, absorbing layers",
    "friction": "dissipated: friction",
    "crack": "dissipated: cracks",
    "closing": "dissipated: contacts opening and closing",
    "law_switch": "supplied: change of law",
    "stepping": "stored: −⅛m(Δv)², Δv of one step",
}
"""Columns of the ledger and their names in the legend."""

BAR_COLUMNS = COLUMNS | {
    "outside": "supplied, net: ends and loads",
    "contact": "stored: elastic, local springs",
    "bond": "stored: elastic, peridynamic bonds",
    "damping": "dissipated: attenuation",
    "law_switch": "supplied: change of method",
}
"""Lines of the ledger of a bar."""

OF_SIDES: dict[str, tuple[str, dict[str, Any]]] = {
    "came_in": ("supplied: through the {}", {"marker": "^"}),
    "absorbed": ("absorbed: by the {}", {"marker": "v", "linestyle": "--"}),
    "stored": ("stored: springs of the {}", {"marker": "s", "linestyle": ":"}),
}
"""Columns of every side, their names in the legend ({} is the side), and their lines; a side has one colour."""

HUES = (COLOURS[0], "#67001F", *COLOURS[1:], "#8C510A", "#999999", "#5E3C99", "#808000", "#003C30")
"""A colour for each column of the ledger, and for each side: four of a body, four of a continuum, one of a column."""

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
"""Prefixes of the unit of energy, by their power of ten."""

OWN_LOOKS: dict[str, dict[str, Any]] = {
    "contact": {"linestyle": "-", "linewidth": 4.0, "alpha": 0.7, "zorder": 1.9},
    "kinetic": {"zorder": 2.1},
    "loads": {"linestyle": "-"},
}
"""Line widths: energies of contacts and bonds are often equal, so one is a thin line above a wide one."""

NEGLIGIBLE, OF_STEPS = 1e-6, 0.02
"""Columns below this share of the largest are left out; the second share is for `stepping`, small in all waves."""

BESIDE = {
    "free_field": " of the column",
    "continuum": " of the continuum",
    "free_field.continuum": " of the continuum below the column",
}
"""Words for sides that do not belong to the body, by the ending of their names."""


class EnergyLine(NamedTuple):
    """A line of the picture: its name in the legend, energies (k,) in J or J/m, style, and least share.

    least : share of the largest of all lines below which it is left out.
    """

    label: str
    values: np.ndarray
    looks: dict[str, Any]
    least: float = NEGLIGIBLE


@styled
def plot_energy(run: Path) -> Figure:
    """The energy ledger of a run against time; below, its error over the supplied energy.

    The work from outside is divided into the energy that came in through every side and by driven loads, and the energy
    that each side absorbed or stores in springs; it is one line if the record does not have these. Columns that are
    negligible during the whole run are left out, as are those that an earlier version did not write.

    Parameters
    ----------
    run
        the ``run.h5`` of a complete run.

    Raises CaseError when the file cannot be read or has no ledger.
    """
    with open_record(run) as file:
        name, columns, bar = text_of(file.attrs["name"]), energy_of(file), is_line(file.attrs["size"])
        sides = side_energies_of(file)
    lines = [*_of_ledger(columns, bar, bool(sides)), *_of_sides(sides, bar)]
    sizes = [float(np.abs(line.values).max(initial=0.0)) for line in lines]
    lines = [line for line, size in zip(lines, sizes, strict=True) if size > line.least * max(sizes)]
    unit = time_unit(columns["time"][-1])
    time = columns["time"] / unit.seconds
    power = power_of_unit(max(sizes, default=0.0))
    figure = new_figure(9.0, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[4, 1])
    for line in lines:
        upper.plot(time, line.values / 10.0**power, label=line.label, gid=line.label, **line.looks)
    lower.plot(time, columns["relative_error"], color=REFERENCE, gid="error of the balance")
    lower.yaxis.set_major_locator(MaxNLocator(nbins=3, min_n_ticks=3))
    lower.yaxis.set_major_formatter(StrMethodFormatter("{x:.3g}"))  # each with its own power, none next to the title
    joule = f"{PREFIXES[power]}J"
    upper.set_ylabel(f"energy ({joule})" if bar else f"energy per metre of thickness ({joule}/m)")
    upper.yaxis.set_major_formatter(Powers())
    lower.set(xlabel=unit.label, ylabel="error (–)")
    lower.set_title("error of the balance over the largest energy supplied", loc="left", fontsize=9, pad=3)
    return finished(figure, f"{name}: energy supplied, stored, absorbed and dissipated", [upper], 3)


def _of_ledger(columns: dict[str, np.ndarray], bar: bool, divided: bool) -> Iterator[EnergyLine]:
    """The columns of the ledger; `divided`: the work from outside is drawn by sides and loads."""
    left_out = "outside" if divided else "loads"
    for index, (column, label) in enumerate((BAR_COLUMNS if bar else COLUMNS).items()):
        if column in columns and column != left_out:
            looks = line_style(index) | {"color": HUES[index]} | OWN_LOOKS.get(column, {})
            yield EnergyLine(label, columns[column], looks, OF_STEPS if column == "stepping" else NEGLIGIBLE)


def _of_sides(sides: dict[str, dict[str, np.ndarray]], bar: bool) -> Iterator[EnergyLine]:
    """For every side the energy that came in, the absorbed energy, and the energy stored in its springs."""
    for column, (label, looks) in OF_SIDES.items():
        for index, (side, energies) in enumerate(sides.items()):
            name, _, beside = side.partition(".")
            place = f"{name} {'end' if bar else 'side'}" + BESIDE.get(beside, "")
            own = {"color": HUES[index % len(HUES)], "markersize": 5.0, "markevery": (3 * index, 12)}
            yield EnergyLine(label.format(place), energies[column], looks | own)


def power_of_unit(largest: float) -> int:
    """The power of ten of the unit in which the largest energy (J or J/m) is from 1 to below 1000, if there is one."""
    power = 3 * floor(log10(largest) / 3.0) if largest > 0.0 else 0
    return min(max(power, min(PREFIXES)), max(PREFIXES))

"""Energy of noise against steps: just below and just above the largest stable step, and at the case's own."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from dembound.plot.style import COLOURS, REFERENCE, decade, new_figure, outside_legend, styled

LEAST, MOST = 1e-20, 1e100
"""Smallest and largest energy drawn, over that of the noise."""


@dataclass(frozen=True)
class Line:
    """Energy of a run over the energy of its noise.

    name : of the run; group : index of the trial, which has one colour; steps (k,); energy (k,); dashed :
    whether the line is dashed.
    """

    name: str
    group: int
    steps: Sequence[int]
    energy: Sequence[float]
    dashed: bool = False


@styled
def plot_stability(short: Sequence[Line], long: Sequence[Line], title: str) -> Figure:
    """Kinetic energy of short runs around the limit (left), and energy at the case's own step (right)."""
    figure = new_figure(10.0, 4.8)
    left, right = figure.subplots(1, 2)
    for panel, lines in ((left, short), (right, long)):
        for line in lines:
            energy = np.clip(np.array(line.energy, dtype=float), LEAST, MOST)
            look = {"color": COLOURS[line.group % len(COLOURS)], "linestyle": "--" if line.dashed else "-"}
            panel.plot(line.steps[: len(energy)], energy, label=line.name, gid=line.name, **look)
        panel.axhline(1.0, color=REFERENCE, linewidth=1.0, zorder=1)
        panel.set_yscale("log")
        panel.yaxis.set_major_formatter(FuncFormatter(decade))
        panel.yaxis.set_minor_formatter(NullFormatter())
        panel.set_xlabel("steps")
        panel.set_xlim(left=0)
    left.set_ylabel("kinetic energy / that of the noise (–)")
    left.set_title("around the largest stable step")
    right.set_ylabel("energy / that of the noise (–)")
    right.set_title("at the case's own step")
    low, high = right.get_ylim()
    right.set_ylim(min(low, 0.1), max(high, 10.0))
    figure.suptitle(title, fontsize=11)
    outside_legend(figure, [left, right], columns=2)
    return figure

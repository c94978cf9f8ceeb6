"""Convergence of calibrations, and energy of noise against steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

from dembound.errors import CaseError
from dembound.plot.style import COLOURS, REFERENCE, decade, finished, new_figure, open_point_style, styled
from dembound.results.reader import open_record, record_names, text_of


@dataclass(frozen=True)
class Passes:
    """A calibration: factors beta (p,) and peaks outgoing (p,) m/s of its passes, incident peak m/s, its task."""

    beta: np.ndarray
    outgoing: np.ndarray
    incident: float
    asked: str


@styled
def plot_convergence(records: Sequence[Path]) -> Figure:
    """Peak M_out at the side, with the incident M_in (upper panel), and factor β (lower panel) against the pass.

    Parameters
    ----------
    records
        ``calibration.h5`` files. A calibration without passes (homogenised) appears only in the legend.

    Raises CaseError when a file cannot be read or none of them has a pass.
    """
    calibrations = [read_passes(path) for path in records]
    if not any(len(each.beta) for each in calibrations):
        raise CaseError([f"{', '.join(map(str, records))}: has no passes to show"])
    figure = new_figure(8.0, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for index, (name, each) in enumerate(zip(record_names(records), calibrations, strict=True)):
        passes = np.arange(1, len(each.beta) + 1)
        style = open_point_style(index)
        upper.plot(passes, each.outgoing, label=f"{name}, {each.asked}", gid=name, **style)
        lower.plot(passes, each.beta, gid=name, label=name, **style)
    for incident in sorted({each.incident for each in calibrations}):
        label = f"incident peak, {incident:.4g} m/s"
        upper.axhline(incident, color=REFERENCE, linewidth=1.0, zorder=1, label=label)
    upper.set_ylabel("peak velocity at the side (m/s)")
    lower.set_ylabel("boundary factor β (–)")
    lower.set_xlabel("pass")
    lower.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    return finished(figure, "Calibration: β is right when the side moves as the incident wave does", [upper], 2)


def read_passes(path: Path) -> Passes:
    """The passes of a calibration.

    Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        asked = {name: text_of(file.attrs[name]) for name in ("boundary", "kind", "wave", "method")}
        return Passes(
            beta=file["beta"][:],
            outgoing=file["outgoing"][:],
            incident=float(file.attrs["incident"]),
            asked=f"{asked['boundary']} {asked['kind']} {asked['wave'].upper()}, {asked['method']}",
        )


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
    return finished(figure, title, [left, right], 2)

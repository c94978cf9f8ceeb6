"""Convergence of calibrations of a boundary's factor β, pass by pass (Z figs 6, 13)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from dembound.errors import CaseError
from dembound.plot.style import REFERENCE, new_figure, open_point_style, outside_legend, styled
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
    figure.suptitle("Calibration: β is right when the side moves as the incident wave does", fontsize=11)
    outside_legend(figure, [upper], columns=2)
    return figure


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

"""Fragments drawn: colours of the disks by their piece, and sieve curves."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from dembound.errors import CaseError
from dembound.plot.style import finished, line_style, new_figure, styled
from dembound.results.pieces import multiples_in, pieces_at, sieve_at
from dembound.results.reader import open_record, record_names, snapshot_of, snapshots_of

NO_PIECE, SINGLE = "#EAEAEA", "#555555"
"""Colours of disks in no fragment and of those that are one alone."""

HUES = (
    *("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8B1A1A", "#F0E442"),
    *("#5E3C99", "#7FBC41", "#8C510A", "#2F2F8F", "#FF9DA7", "#00CED1", "#B8860B", "#D01C8B"),
)
"""Colours of fragments of two disks or more, which several of them share."""

PALETTE = ListedColormap([NO_PIECE, SINGLE, *HUES])
"""The colours by number: of no fragment, single disks, and fragments."""


def hues_at(file: h5py.File, time: float) -> np.ndarray:
    """Number (n,) in `PALETTE` of each disk at a snapshot of an open record, 0 for all if no bond broke.

    Fragments keep their hues in a run; the largest at its end have different ones. time : of the snapshot, s.
    """
    pieces = pieces_at(file, time)
    if pieces is None:
        return np.zeros(len(file["particles/radius"]))
    number, snapshot, mass = multiples_in(file)
    latest = np.lexsort((-mass, -snapshot))
    _, first = np.unique(number[latest], return_index=True)
    ranked = number[latest][np.sort(first)]
    hues = np.ones(len(pieces) + 1)
    hues[0] = 0.0
    hues[ranked] = 2 + np.arange(len(ranked)) % len(HUES)
    alone = (np.bincount(pieces)[pieces] == 1) & (pieces > 0)
    return np.where(alone, 1.0, hues[pieces])


def name_hues(panel: Axes, drawn: np.ndarray) -> None:
    """Entries in the legend for the colours of disks with the numbers (n,) in `PALETTE`."""
    names = {
        0: "in no fragment: held by a side, or without bonds",
        1: "single disk",
        2: "fragments of two disks or more: a hue each, in turn",
    }
    for number, name in names.items():
        if (np.minimum(drawn, 2) == number).any():
            colour = PALETTE(number)
            panel.scatter([], [], s=40, color=[colour], edgecolors="none", label=name)


@styled
def plot_sieve(runs: Sequence[Path], snapshot: int | None = None) -> Figure:
    """Sieve curves of the fragments of runs: the share of their mass in fragments not larger than a diameter.

    Dashed lines are at the mean diameter of the disks, below which nothing is resolved.

    Parameters
    ----------
    runs
        ``run.h5`` files of disks.
    snapshot
        number of the snapshot; negative ones count from the last, which is the default.

    Raises CaseError when a file cannot be read, has no such snapshot, or no run has fragments.
    """
    figure = new_figure(8.0, 5.2)
    panel = figure.subplots()
    lacking = []
    for index, (label, run) in enumerate(zip(record_names(runs), runs, strict=True)):
        with open_record(run) as file:
            group = snapshots_of(file, required=True)[-1] if snapshot is None else snapshot_of(file, snapshot)
            time = float(group.attrs["time"])
            found, disk = sieve_at(file, time), 2.0 * float(file["particles/radius"][:].mean())
        if found is None:
            lacking.append(
                f"{run}: has no fragments at t = {time:.3g} s; complete runs whose bonds broke may have some"
            )
            continue
        diameters, finer = found
        ends = np.append(diameters, diameters[-1]), np.append(finer, finer[-1])
        ends[0][-1] *= 1.2  # the curve goes on at 100 %
        look: dict[str, Any] = {"linewidth": 1.6, **line_style(index)}
        panel.plot(*ends, drawstyle="steps-post", label=f"{label}, t = {time:.3g} s", gid=label, **look)
        panel.vlines(diameters[0], 0.0, finer[0], **look)
        panel.axvline(disk, color=look["color"], linestyle="--", linewidth=0.8)
    if len(lacking) == len(runs):
        raise CaseError(lacking)
    panel.set(xscale="log", ylim=(0.0, 1.02), xlabel="equivalent diameter √(4A/π) (m)")
    panel.set_ylabel("share of the fragments' mass not larger (–)")
    panel.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.xaxis.set_major_formatter("{x:g}")
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.plot([], [], label="mean diameter of the disks", color="black", linewidth=0.8, linestyle="--")
    return finished(figure, "Sieve curves of the fragments", [panel], 3)

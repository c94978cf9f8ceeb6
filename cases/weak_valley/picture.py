"""Draws the end of ``weak_valley.toml`` with and without zones of unbroken bonds, and the motion of its bottom.

dembound run weak_valley.toml
dembound run weak_valley.toml --name without --set boundary.left.intact=0 --set boundary.right.intact=0 \
    --set boundary.bottom.intact=0
python weak_valley/picture.py results/weak_valley results/without breaking_ground.png
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from dembound.plot.style import new_figure, styled
from dembound.results.reader import open_record

FARTHEST = 5.0
"""Displacement (m) from which on colours are the same."""


def draw_end(axes: Axes, record: Path) -> EllipseCollection:
    """The disks of the body where they are at the end, coloured by how far they have moved; returns the colours."""
    with open_record(record) as file:
        body = ~file["particles/column"][:]
        places, radii = file["particles/position"][:][body], file["particles/radius"][:][body]
        last = max(file["snapshots"], key=int)
        moved = file[f"snapshots/{last}/displacement"][:, :2][body]
        time = float(file[f"snapshots/{last}"].attrs["time"])
    width = 2.0 * radii
    disks = EllipseCollection(width, width, np.zeros(len(width)), units="xy", offsets=places + moved)
    disks.set(array=np.hypot(*moved.T), clim=(0.0, FARTHEST), cmap="viridis", transOffset=axes.transData)
    axes.add_collection(disks)
    (left, bottom), (right, top) = places.min(axis=0) - 2.0, places.max(axis=0) + 2.0
    axes.set(xlim=(left, right), ylim=(bottom - 2.0, top), aspect="equal", xlabel="x (m)", ylabel="y (m)")
    axes.set_title(f"t = {time:.3g} s")
    return disks


@styled
def draw(kept: Path, without: Path) -> Figure:
    """Both ends, and below them the vertical displacement of the bottom in both runs."""
    figure = new_figure(9.0, 6.0)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.6, 1.0])
    for column, (name, run) in enumerate({"bonds kept beside the sides": kept, "all bonds may break": without}.items()):
        axes = figure.add_subplot(grid[0, column])
        disks = draw_end(axes, run / "run.h5")
        axes.set_title(f"{name}, {axes.get_title()}")
    figure.colorbar(disks, ax=figure.axes, label="displacement (m)", shrink=0.8, pad=0.02)
    below = figure.add_subplot(grid[1, :])
    for name, run in (("bonds kept beside the sides", kept), ("all bonds may break", without)):
        with open_record(run / "run.h5") as file:
            side = file["boundaries/bottom"]
            below.plot(side["time"][:], 1e3 * side["displacement"][:, 1], label=name)
    below.set(xlabel="time (s)", ylabel="mean vertical displacement\nof the bottom (mm)")
    below.legend()
    return figure


if __name__ == "__main__":
    kept, without, picture = map(Path, sys.argv[1:])
    draw(kept, without).savefig(picture)

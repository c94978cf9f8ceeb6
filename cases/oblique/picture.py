"""Draws the motion of ``oblique.toml``: total velocity at some times, and velocity of the tunnel's wall.

dembound run oblique.toml
python oblique/picture.py results/oblique oblique.png
"""

import sys
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation

SHOWN = (1, 2, 3)
"""Numbers of the snapshots."""

LIMIT = 0.7
"""Largest velocity (m/s) of the colours."""


def main() -> None:
    """Draw the run in a folder to a picture."""
    run, picture = map(Path, sys.argv[1:])
    with h5py.File(run / "run.h5") as file:
        figure, axes = plt.subplots(1, 4, figsize=(13.0, 4.6), layout="constrained", width_ratios=[1, 1, 1, 1.5])
        for place, number in zip(axes, SHOWN, strict=False):
            shown = draw(place, file, file[f"snapshots/{number:04d}"])
        figure.colorbar(shown, ax=axes[:3], label="velocity along x (m/s)", location="bottom", shrink=0.6)
        for name, looks in (("left", "-"), ("left.free_field", "--")):
            history = file[f"histories/{name}"]
            for component, colour in zip("xy", ("C0", "C3"), strict=True):
                values = history["velocity"][:, "xy".index(component)]
                what = "without the tunnel" if "." in name else "left wall"
                axes[3].plot(history["time"][:], values, looks, color=colour, label=f"{component}, {what}")
    axes[3].set(xlabel="time (s)", ylabel="velocity (m/s)", title="left wall of the tunnel")
    axes[3].legend()
    figure.savefig(picture, dpi=110)


def draw(axes: plt.Axes, file: h5py.File, snapshot: h5py.Group) -> plt.cm.ScalarMappable:
    """The velocity along x within the layers, of the continuum and of the disks."""
    looks = {"cmap": "RdBu_r", "vmin": -LIMIT, "vmax": LIMIT}
    around, cells = file["continuum"], file["continuum/cell"][:]
    cells = cells[~(around["absorbs"][:][cells].any(axis=1))]
    triangles = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    mesh = Triangulation(*around["position"][:].T, triangles)
    axes.tripcolor(mesh, snapshot["continuum/velocity"][:, 0], shading="gouraud", **looks)
    disks, velocity = file["particles/position"][:], snapshot["velocity"][:, 0]
    shown = axes.scatter(*disks.T, c=velocity, s=1.2, marker="s", linewidths=0.0, **looks)
    (left, bottom), (right, top) = disks.min(axis=0), disks.max(axis=0)
    axes.plot([left, right, right, left, left], [bottom, bottom, top, top, bottom], "k-", linewidth=0.6)
    title = f"t = {float(snapshot.attrs['time']):.2g} s"
    axes.set(aspect="equal", xlim=(90.0, 210.0), ylim=(90.0, 300.0), xlabel="x (m)", ylabel="y (m)", title=title)
    return shown


if __name__ == "__main__":
    main()

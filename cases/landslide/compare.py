"""Draws a landslide at four times and the motion of its block beside that in a rigid box, and prints what differs.

python landslide/compare.py results/landslide/landslide results/landslide/rigid_box landslide.png
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import matplotlib.pyplot as plt
import numpy as np

from dembound.plot.disks import Window
from dembound.plot.field import read_disks
from dembound.plot.field_reader import find_field
from dembound.plot.scene import draw_panel

TIMES = (0.0, 6.0, 8.0, np.inf)
"""Times of the pictures, s; the last one is the end."""

WINDOW = Window(np.array([30.0, 0.0]), np.array([160.0, 65.0]))
"""What they show, m."""

PLATEAU = "surface_4"
"""A monitor behind the crest."""


def main() -> None:
    """Draw and compare two runs."""
    runs, picture = [Path(each) for each in sys.argv[1:3]], Path(sys.argv[3])
    figure, axes = plt.subplots(3, 2, figsize=(13.0, 9.5), layout="constrained", height_ratios=[1.0, 1.0, 0.9])
    strip(figure, axes[:2].ravel(), runs[0] / "run.h5")
    for run, colour in zip(reversed(runs), ("C1", "C0"), strict=True):  # the first one above the other
        with h5py.File(run / "run.h5") as file:
            block, plateau = file["histories/block"], file[f"histories/{PLATEAU}"]
            moved = np.hypot(*block["displacement"][:, :2].T)
            axes[2, 0].plot(block["time"][:], moved, colour, label=run.name.replace("_", " "))
            axes[2, 1].plot(plateau["time"][:], plateau["velocity"][:, 0], colour, linewidth=0.8)
    axes[2, 0].set(xlabel="time (s)", ylabel="displacement (m)", title="mean of the block")
    axes[2, 1].set(xlabel="time (s)", ylabel="velocity along x (m/s)", title="the plateau behind it")
    axes[2, 0].legend()
    figure.savefig(picture, dpi=110)
    print(f"{'':28}" + "".join(f"{run.name:>12}" for run in runs))
    for words, *values in zip(*(rows(json.loads((run / "summary.json").read_text())) for run in runs), strict=True):
        print(words[0][:28].ljust(28) + f"{words[1]:>12}" + "".join(f"{value:>12}" for _, value in values))


def strip(figure: plt.Figure, axes: np.ndarray, record: Path) -> None:
    """The scene at four times, coloured by displacement."""
    with h5py.File(record) as file:
        disks, found = read_disks(file), find_field(file, "displacement", "x", 1.0)
        times = [float(group.attrs["time"]) for group in found.groups]
        chosen = [found.groups[int(np.argmin(np.abs(np.minimum(time, times[-1]) - times)))] for time in TIMES]
        shown = found.at(chosen)
        scale = 5.6 * figure.dpi / WINDOW.size[0]
        for number, place in enumerate(axes):
            colours = draw_panel(place, disks, shown, number, WINDOW, scale, numbered=False)
            place.set_title(shown.captions[number])
    figure.colorbar(colours, ax=axes, label=shown.label, shrink=0.6, extend=shown.extend)


def rows(summary: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Numbers of a run in words."""
    debris, joint = summary["debris"], summary["joints"]["bedding"]
    way = debris["right"]
    return [
        ("plateau, peak velocity", f"{abs(summary['monitors'][PLATEAU]['peak_velocity']):.2f} m/s"),
        ("bonds broken", f"{sum(summary['cracks'].values()):,}"),
        ("bedding plane slides from", f"{joint['slides_from']:.2f} s"),
        ("mass that moved", f"{debris['mass'] / 1e3:,.0f} t/m"),
        ("run-out x95", f"{way['x95']:.1f} m"),
        ("run-out x99", f"{way['x99']:.1f} m"),
        ("angle to the crest", f"{way['angle']:.1f}°"),
        ("largest fragment", f"{debris['fragments']['largest']:.1f} m"),
        ("single disks", f"{100.0 * debris['fragments']['singles']:.0f} %"),
        ("at rest from", "–" if debris["rest"] is None else f"{debris['rest']:.1f} s"),
    ]


if __name__ == "__main__":
    main()

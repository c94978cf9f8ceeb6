"""Draws ``first_tunnel.toml`` while the wave passes the hole: the whole scene, and the disks at the wall.

dembound run first_tunnel.toml --set outside.margin=10 --set output.snapshots=50 --name wide
python first_tunnel/picture.py results/wide tunnel_box.png
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from dembound.plot.disks import Window
from dembound.plot.field import read_disks
from dembound.plot.field_reader import read_field
from dembound.plot.scene import draw_panel
from dembound.plot.style import new_figure, styled
from dembound.results.reader import open_record

SNAPSHOT = 17
"""Number of the snapshot that is drawn."""

LIMIT = 0.6
"""Largest velocity (m/s) of the colours."""

SCENE = Window(np.array([40.0, 0.0]), np.array([80.0, 60.0]))
CLOSE = Window(np.array([83.0, 36.0]), np.array([12.0, 14.0]))
"""What the two panels show, in metres: most of the ground, and a corner of the box with part of the wall."""

INCHES_PER_METRE = 4.2 / 60.0
"""Of the scene; the other panel is as high."""

ARROW = {"arrowstyle": "-|>", "linewidth": 1.5, "color": "black"}


@styled
def draw(run: Path) -> Figure:
    """The velocity along x in disks and continuum at one time of a run."""
    with open_record(run / "run.h5") as file:
        disks, field = read_disks(file), read_field(file, "velocity", "x", SNAPSHOT, 1)
    field = replace(field, limits=(-LIMIT, LIMIT))
    height = INCHES_PER_METRE * SCENE.size[1]
    widths = [height * window.size[0] / window.size[1] for window in (SCENE, CLOSE)]
    figure = new_figure(sum(widths) + 2.2, height + 0.9)
    left, right = figure.subplots(1, 2, width_ratios=widths)
    for panel, window in ((left, SCENE), (right, CLOSE)):
        scale = figure.dpi * height / window.size[1]
        colours = draw_panel(panel, disks, field, 0, window, scale)
    (x, y), (across, up) = CLOSE.corner, CLOSE.size
    left.add_patch(Rectangle((x, y), across, up, fill=False, linewidth=1.2, linestyle="--"))
    left.annotate("", (46.0, 18.0), (46.0, 4.0), arrowprops=ARROW)
    left.text(48.0, 10.0, "S pulse", va="center")
    left.text(78.5, 35.0, "tunnel", ha="center", va="center")
    figure.colorbar(colours, ax=[left, right], label=field.label, shrink=0.9, pad=0.02)
    left.set_title(f"{disks.in_words}, {field.captions[0]}")
    right.set_title("disks, ties and elements")
    return figure


if __name__ == "__main__":
    run, picture = map(Path, sys.argv[1:])
    draw(run).savefig(picture, dpi=90, pil_kwargs={"optimize": True})

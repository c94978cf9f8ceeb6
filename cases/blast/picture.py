"""Draws docs/pictures/blast.png: forces of the pressure on the disks of the wall, motion beside the exact cavity.

python cases/blast/picture.py [FILE]      (default: blast.png; half a minute of CPU time)
"""

import sys
from pathlib import Path

import numpy as np
from errors import BOX, PRESSURE, RADIUS, Motion, quarter
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from dembound.disks.scene import build
from dembound.disks.supports import forces_of
from dembound.plot.style import COLOURS, REFERENCE, new_figure, save, styled

COARSE = 1.0
"""Diameter (m) of the disks in the picture of the wall."""

FULL = 2.0
"""Length (m) of the arrow of a force p·D."""

PLACE = 9
"""Number of the place shown: 1.5 radii at 22.5°."""


def draw_wall(panel: Axes, on: str) -> None:
    """The disks of the wall, the outline of the hole, and the forces of the pressure."""
    scene = build(quarter(COARSE, BOX, "free", **{"load.blast.on": on}))
    places, (nodes, forces) = scene.positions, forces_of(scene.case.load[0], scene)
    sizes = np.full(len(places), COARSE)
    panel.add_collection(
        EllipseCollection(
            sizes, sizes, 0.0 * sizes, units="xy", offsets=places, offset_transform=panel.transData,
            facecolor="0.88", edgecolor="0.6", linewidth=0.5,
        )
    )  # fmt: skip
    angle = np.linspace(0.0, 0.5 * np.pi, 100)
    panel.plot(RADIUS * np.cos(angle), RADIUS * np.sin(angle), color=COLOURS[1], label="outline")
    arrows = FULL * forces[:, :2] / (PRESSURE * COARSE)
    panel.quiver(
        *places[nodes].T, *arrows.T, angles="xy", scale_units="xy", scale=1.0, color=COLOURS[0], width=0.007, zorder=3
    )
    panel.set_aspect("equal")
    panel.set_xlim(0.0, 13.0)
    panel.set_ylim(0.0, 13.0)
    panel.set_title(f'on = "{on}"')
    panel.set_xlabel("x from the axis (m)")
    panel.set_ylabel("y from the axis (m)")


def draw_motion(panel: Axes) -> None:
    """Radial velocity at a place, exact, with a continuum and with dashpots beyond the box."""
    for index, (side, name) in enumerate({"outside": "continuum beyond the box", "viscous": "dashpots"}.items()):
        motion = Motion(quarter(0.5, BOX, side))
        place = motion.places[PLACE]
        outwards = place / np.hypot(*place)
        if index == 0:
            exact = motion.exact()[1]
            panel.plot(
                motion.times, exact[:, PLACE] @ outwards, "--", color=REFERENCE, linewidth=2.5, label="exact", zorder=3
            )
        panel.plot(motion.times, motion.velocity[:, PLACE] @ outwards, color=COLOURS[index], label=name)
    panel.set_title(f"at {np.hypot(*place) / RADIUS:.2f} radii, 20 diameters in a radius")
    panel.set_xlabel("time (s)")
    panel.set_ylabel("radial velocity (m/s)")
    panel.legend()


@styled
def blast() -> Figure:
    """The wall with both ways of loading it, and the motion."""
    figure = new_figure(13.0, 4.6)
    panels = figure.subplots(1, 3)
    for panel, on in zip(panels, ("outline", "bonds"), strict=False):
        draw_wall(panel, on)
    draw_motion(panels[2])
    figure.suptitle("Forces of a pressure on the disks at a hole of ten diameters' radius, and the motion it makes")
    return figure


if __name__ == "__main__":
    save(blast(), Path(sys.argv[1] if len(sys.argv) > 1 else "blast.png"))

"""Packings: a brick with its seams, and close-ups of packings at an edge (Z figs 2, 9, 10)."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from dembound.plot.disks import Window, draw_disks, frame
from dembound.plot.style import COLOURS, finished, new_figure, styled

BLUE, RED, GREEN, YELLOW = (COLOURS[index] for index in (0, 1, 2, 5))

KINDS = {"interior": YELLOW, "controller": BLUE, "follower": RED, "regular row": GREEN}
"""Kinds of disks and their colours, as in Z except for the rows: followers are periodic images of controllers."""

CLOSE_UP_DIAMETERS = 16
"""Width of a close-up over the largest mean diameter of its packings."""


@styled
def plot_brick(
    positions: np.ndarray,
    radii: np.ndarray,
    rows: np.ndarray,
    size: np.ndarray,
    pairs: np.ndarray | None = None,
    images: np.ndarray | None = None,
) -> Figure:
    """A brick with the disks of its neighbours that extend into it; with pairs and images, its contacts too.

    A disk that crosses a face of the periodic box is a controller; on the other side its periodic image is drawn as a
    follower. In a copy of the brick there, this disk is the controller.

    Parameters
    ----------
    positions (n, 2), radii (n,), size (2,)
        m, as in `packings.brick.Brick`.
    rows
        (n, 2) bool, members of the regular rows.
    pairs, images
        (b, 2) int, contacts i → j and the periodic images of j.
    """
    size = np.asarray(size)
    places, disks, kinds = brick_disks(positions, radii, rows, size)
    window = Window.around(places, radii[disks])
    figure = new_figure(7.5, 6.9 * window.size[1] / window.size[0] + 1.3)
    panel = figure.subplots()
    for kind, colour in KINDS.items():
        chosen = kinds == kind
        if chosen.any():
            _draw_kind(panel, places[chosen], radii[disks[chosen]], colour, f"{kind} ({np.count_nonzero(chosen)})")
    panel.add_patch(Rectangle((0.0, 0.0), *size, fill=False, linewidth=1.5, label="faces of the brick"))
    title = f"Brick of {size[0]:g} m × {size[1]:g} m; disks: {len(radii)}"
    if pairs is not None and images is not None:
        ends = np.stack([positions[pairs[:, 0]], positions[pairs[:, 1]] + images * size], axis=1)
        across = images.any(axis=1)  # shown at both faces, on either side of the brick
        ends = np.concatenate([ends, ends[across] - (images[across] * size)[:, None, :]])
        panel.add_collection(LineCollection(list(ends), colors="black", linewidths=0.6, label="contact"), autolim=False)
        title += f", contacts: {len(pairs)}"
    frame(panel, window)
    return finished(figure, title, [panel], 3)


def brick_disks(
    positions: np.ndarray, radii: np.ndarray, rows: np.ndarray, size: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every disk of a brick and every follower of its neighbours that extends into the box.

    Arguments as in `plot_brick`. Returns places (m, 2) m, numbers (m,) of the disks in the brick, and kinds
    (m,), keys of `KINDS`; the first n belong to the brick.
    """
    box = Window(np.zeros(2), size)
    own = np.arange(len(radii))
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])
    images = (positions + steps[:, None, :] * size).reshape(-1, 2)
    owners = np.tile(own, len(steps))
    inside = box.touches(images, radii[owners])
    kinds = np.full(len(radii), "interior", dtype=object)
    kinds[owners[inside]] = "controller"
    kinds[rows.any(axis=1)] = "regular row"
    followers = np.full(np.count_nonzero(inside), "follower", dtype=object)
    return (
        np.concatenate([positions, images[inside]]),
        np.concatenate([own, owners[inside]]),
        np.concatenate([kinds, followers]),
    )


@styled
def plot_patterns(parts: Mapping[str, tuple[np.ndarray, np.ndarray, np.ndarray]]) -> Figure:
    """Close-ups of packings at one edge, side by side in the same scale, with coloured particles of the edge.

    Parameters
    ----------
    parts
        name -> positions (n, 2) m, radii (n,) m, and the indices (k,) of the edge's particles.
    """
    span = CLOSE_UP_DIAMETERS * max(2.0 * float(radii.mean()) for _, radii, _ in parts.values())
    figure = new_figure(4.2 * len(parts) + 0.4, 5.0)
    panels = figure.subplots(1, len(parts), squeeze=False)[0]
    for panel, (name, (positions, radii, edge)) in zip(panels, parts.items(), strict=True):
        window = _edge_window(positions, radii, edge, span)
        exposed = np.zeros(len(radii), dtype=bool)
        exposed[edge] = True
        near = window.touches(positions, radii)
        for chosen, colour, label in (
            (near & ~exposed, "#D0D0D0", "other particles"),
            (near & exposed, BLUE, "boundary particles"),
        ):
            _draw_kind(panel, positions[chosen], radii[chosen], colour, label)
        frame(panel, window)
        panel.set_title(f"{name}: {len(edge)} boundary particles")
    return finished(figure, "Packings at the boundary", panels, 2)


def _edge_window(positions: np.ndarray, radii: np.ndarray, edge: np.ndarray, span: float) -> Window:
    """A square of `span` metres around the middle of an edge, with the edge just inside one of its sides."""
    places = positions[edge]
    axis = int(np.argmin(np.ptp(places, axis=0)))
    outward = np.sign(places[:, axis].mean() - positions[:, axis].mean())
    margin = float(radii.max())
    face = np.max(outward * places[:, axis] + radii[edge]) + margin
    corner = np.median(places, axis=0) - 0.5 * span
    corner[axis] = min(outward * face, outward * (face - span))
    return Window(corner, np.full(2, span))


def _draw_kind(panel: Axes, positions: np.ndarray, radii: np.ndarray, colour: str, label: str) -> None:
    """Disks of one kind, with an entry in the legend."""
    draw_disks(panel, positions, radii, facecolors=colour, edgecolors="white", linewidths=0.3)
    panel.scatter([], [], s=50, color=colour, label=label)

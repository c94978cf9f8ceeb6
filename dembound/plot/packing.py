"""Disks and their contacts: a brick with its seams, packings at an edge (Z figs 2, 9, 10), and force chains.

Force chains are contacts as lines between the centres of disks, as wide as their normal forces are large.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from dembound.errors import CaseError
from dembound.plot.disks import SMALLEST_PIXELS, Window, draw_disks, frame
from dembound.plot.field import read_disks
from dembound.plot.lines import mark_seams, mark_walls
from dembound.plot.scene import DRAWING, LONG, part_around
from dembound.plot.style import COLOURS, finished, new_figure, styled
from dembound.results.reader import open_record, snapshot_of, snapshots_of, walls_at

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
    kinds = np.append(kinds, np.full(np.count_nonzero(inside), "follower", dtype=object))
    return np.concatenate([positions, images[inside]]), np.append(own, owners[inside]), kinds


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
        for of_edge, colour, label in ((False, "#D0D0D0", "other particles"), (True, BLUE, "boundary particles")):
            chosen = near & (exposed == of_edge)
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


COLUMN = "contacts/normal_force"
"""Dataset of a snapshot with the forces drawn."""

WIDEST = 0.5
"""Width of the widest lines over the mean diameter of disks."""

LEAST_WIDTH = 2.0
"""Least width (points) of the widest lines, where disks are small."""

FEW = 0.01
"""Share of the contacts with lines of equal width, those with the largest forces, which are several times the
others.
"""

NARROWEST = 4.0
"""Least width (inches) of the page for title and legend."""

MOST_LINES = 30_000
"""Largest number of lines in a picture; the largest forces are drawn."""

PUSH, PULL = COLOURS[0], COLOURS[1]
"""Colours of compression and tension."""

SHADE = "#E3E3E3"
"""Colour of the disks."""


@dataclass(frozen=True)
class Chains:
    """Contacts at one time.

    time in s; positions (n, 2) m of the disks; pairs (b, 2) of disks; ends (b, 2, 2) m of the lines; force (b,) N/m
    along them, tension positive; walls (p, 2) m, the points of each.
    """

    time: float
    positions: np.ndarray
    pairs: np.ndarray
    ends: np.ndarray
    force: np.ndarray
    walls: tuple[np.ndarray, ...] = ()

    @property
    def largest(self) -> np.ndarray:
        """(n,) N/m, the largest force on each disk without its sign."""
        largest = np.zeros(len(self.positions))
        np.maximum.at(largest, self.pairs, np.abs(self.force)[:, None])
        return largest


@styled
def plot_chains(run: Path, snapshot: int | None = None) -> Figure:
    """The contacts of a scene, or of a part of one that is long, with the disks behind them at their present positions.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    snapshot
        its number; negative ones count from the last. By default the one with the largest sum of forces.

    Raises CaseError when the file cannot be read, or has no such snapshot or no contacts.
    """
    with open_record(run) as file:
        disks, chains = read_disks(file), read_chains(file, snapshot)
    window, size = disks.own_window, disks.own_window.size
    if max(size) > LONG * min(size):  # the part around the largest forces
        window = part_around(disks, disks.positions[np.argmax(chains.largest)])
    scale = min(DRAWING / window.size)
    width, height = scale * window.size
    figure = new_figure(max(width, NARROWEST) + 1.2, height + 1.8)
    panel = figure.subplots()
    frame(panel, window)
    if 2.0 * float(disks.radii.mean()) * scale * figure.dpi >= SMALLEST_PIXELS:
        shown = window.touches(chains.positions, disks.radii)
        draw_disks(panel, chains.positions[shown], disks.radii[shown], facecolors=SHADE, linewidths=0.0)
    drawn = _draw_lines(panel, window, chains, max(LEAST_WIDTH, 72.0 * scale * WIDEST * 2.0 * disks.radii.mean()))
    mark_walls(panel, chains.walls)
    mark_seams(panel, disks, window)
    return finished(figure, f"{disks.case}: normal forces of {drawn}, t = {chains.time:.3g} s", [panel], 3)


def read_chains(file: h5py.File, snapshot: int | None) -> Chains:
    """The contacts of an open record at a snapshot, see `plot_chains`."""
    groups = snapshots_of(file, required=True)
    if COLUMN not in groups[0]:
        raise CaseError([f"{file.filename}: holds no contacts; runs with output.contacts = true do"])
    if snapshot is None:
        group = max(groups, key=lambda each: float(np.abs(each[COLUMN][:]).sum()))
    else:
        group = snapshot_of(file, snapshot)
    positions = file["particles/position"][:] + group["displacement"][:, :2]
    pairs = group["contacts/particles"][:]
    begin = positions[pairs[:, 0]]
    ends = np.stack([begin, begin + group["contacts/vector"][:]], axis=1)
    time = float(group.attrs["time"])
    return Chains(time, positions, pairs, ends, group[COLUMN][:], tuple(walls_at(file, time).values()))


def _draw_lines(panel: Axes, window: Window, chains: Chains, widest: float) -> str:
    """Draw the contacts in a window, the widest with a width in points; returns in words what is drawn."""
    inside = ((chains.ends >= window.corner) & (chains.ends <= window.corner + window.size)).all(axis=2).any(axis=1)
    ends, force = chains.ends[inside], chains.force[inside]
    chosen = np.argsort(np.abs(force), kind="stable")[-MOST_LINES:]
    ends, force = ends[chosen], force[chosen]
    full = float(np.quantile(np.abs(force), 1.0 - FEW)) if len(force) > 0 else 0.0
    widths = widest * np.minimum(np.abs(force) / (full or 1.0), 1.0)
    colours = np.where(force < 0.0, PUSH, PULL).tolist()
    panel.add_collection(LineCollection(list(ends), linewidths=widths, colors=colours, capstyle="round"), autolim=False)
    panel.plot([], [], color=PUSH, linewidth=widest, label=f"compression, {_in_words(full)} or more")
    panel.plot([], [], color=PULL, linewidth=0.5 * widest, label=f"tension, {_in_words(0.5 * full)}")
    count = np.count_nonzero(inside)
    return f"{count:,} contacts" if count == len(chosen) else f"the {len(chosen):,} strongest of {count:,} contacts"


def _in_words(force: float) -> str:
    """A force in N/m with two digits."""
    return f"{np.format_float_positional(force / 1e3, precision=2, fractional=False, trim='-')} kN/m"

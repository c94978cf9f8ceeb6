"""The outlines of the holes in the case of a record."""

from collections.abc import Iterator, Sequence
from typing import Any

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from pydantic import TypeAdapter, ValidationError

from dembound.casefile.reader import parsed
from dembound.casefile.types import HoleTable
from dembound.errors import CaseError
from dembound.holes.hole import Hole
from dembound.holes.outline import Outline
from dembound.plot.disks import EMPTY, Window
from dembound.results.reader import text_of

HOLES: TypeAdapter[Any] = TypeAdapter(list[HoleTable])  # type: ignore[valid-type]

TRUE_TO = 0.1
"""Largest distance of two points of a line, in mean diameters; corners are cut by half of it at most."""

MOST_POINTS = 20_000
"""Largest number of points of an outline."""

FIRST = 256
"""Number of points from which the lengths of an outline's pieces are estimated."""

ABOVE_FIELD, ABOVE_FILLING = 1.2, 1.3
"""Drawing order: of the filling of holes, above the image of disks; of their outlines."""


def read_holes(file: h5py.File) -> tuple[Hole, ...]:
    """The holes in the case of an open record; none without its text, or of types that are not installed here."""
    try:
        return tuple(HOLES.validate_python(parsed(text_of(file.attrs.get("case", ""))).get("hole", [])))
    except (CaseError, ValidationError):
        return ()


def draw_outlines(axes: Axes, holes: Sequence[Hole], body: Window, diameter: float, *, filled: bool) -> None:
    """Add the outlines of holes to the axes, as far as they are within the body.

    diameter : mean diameter of the disks, m. filled : whether outlines are filled with the colour of gaps.
    """
    left, right, bottom, top = body.extent
    for outline in (hole.outline for hole in holes):
        if outline is None:
            continue
        if filled:
            whole = Path(_points(outline, (0.0, outline.period), diameter), closed=True)
            within = Rectangle((left, bottom), right - left, top - bottom, transform=axes.transData)
            patch = PathPatch(whole, facecolor=EMPTY, linewidth=0.0, zorder=ABOVE_FIELD)
            axes.add_patch(patch).set_clip_path(within)
        looks: dict[str, Any] = {"fill": False, "edgecolor": "black", "linewidth": 1.0, "zorder": ABOVE_FILLING}
        for line in lines_of(outline, body, diameter):
            axes.add_patch(PathPatch(Path(line), **looks))


def lines_of(outline: Outline, body: Window, diameter: float) -> Iterator[np.ndarray]:
    """The parts (k, 2) m of an outline that lie within a body."""
    left, right, bottom, top = body.extent
    for part in outline.within((left, bottom, right, top)):
        yield _points(outline, part, diameter)


def _points(outline: Outline, part: tuple[float, float], diameter: float) -> np.ndarray:
    """Points (k, 2) m of a part that begins somewhere and has a length, in the parameter of the outline."""
    begin, length = part
    steps = np.diff(outline.at(begin + np.linspace(0.0, length, FIRST)), axis=0)
    longest = FIRST * float(np.hypot(*steps.T).max())
    count = int(np.clip(longest / (TRUE_TO * diameter), FIRST, MOST_POINTS))
    return outline.at(begin + np.linspace(0.0, length, count))

"""Names beside the points of a diagram where they fit, and numbers where they do not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

BESIDE: list[tuple[tuple[float, float], str, str]] = [
    *(((x, y), ha, va) for x, ha in ((7.0, "left"), (-7.0, "right")) for y, va in ((0.0, "center"),)),
    *(((x, y), ha, va) for y, va in ((5.0, "bottom"), (-5.0, "top")) for x, ha in ((5.0, "left"), (-5.0, "right"))),
    *(((0.0, y), "center", va) for y, va in ((7.0, "bottom"), (-7.0, "top"))),
    *(((x, y), ha, va) for y, va in ((11.0, "bottom"), (-11.0, "top")) for x, ha in ((11.0, "left"), (-11.0, "right"))),
]
"""Places of a name beside its point: offset in points, horizontal and vertical alignment, in the order of trial."""

AROUND: list[tuple[tuple[float, float], str, str]] = [
    ((radius * np.cos(angle), radius * np.sin(angle)), "center", "center")
    for radius in (12.0, 17.0, 25.0)
    for angle in np.radians([45, 225, 135, 315, 0, 90, 180, 270, *range(22, 360, 45)])
]
"""Places of a number, which is short and may stand a little apart."""

GAP, APART, STEP = 2.0, 6.0, 3.0
"""Distances in points between two labels, between a label and another point, and between places on an uncovered
line.
"""

FARTHER = {True: 1.2, False: 1.02}
"""Least distance of other points from a label over the distance of its own point, for a name and for a number."""


@dataclass(frozen=True)
class Labelled:
    """A point with its number and its name; place : in the units of the axes; is_bold : whether it is placed first."""

    number: int
    name: str
    place: tuple[float, float]
    colour: str
    is_bold: bool


@dataclass
class Labels:
    """Labels of a panel whose layout is final.

    lines : of the panel, each (k, 2), that names must not cover. taken : occupied rectangles, in pixels.
    """

    panel: Axes
    points: Sequence[Labelled]
    lines: Sequence[np.ndarray] = ()
    taken: list[Bbox] = field(default_factory=list)

    def write(self, most_named: int) -> list[int]:
        """Write all labels, bold ones first; gives the numbers of the points whose name is not written.

        Of more than `most_named` points only bold ones get names. Some points may have no room for a number either.
        """
        order = sorted(self.points, key=lambda each: not each.is_bold)
        named = order if len(order) <= most_named else [each for each in order if each.is_bold]
        numbered = [each for each in order if each not in named or not self._placed(each, each.name, BESIDE)]
        for each in numbered:
            self._placed(each, str(each.number), AROUND)
        return [each.number for each in numbered]

    def _placed(self, point: Labelled, text: str, places: Iterable[tuple[tuple[float, float], str, str]]) -> bool:
        """Write a text at the first free one of several places beside its point; returns whether one is free."""
        is_name = text != str(point.number)
        others = self._pixels([each.place for each in self.points if each.place != point.place])
        lines = np.concatenate([np.empty((0, 2)), *(list(self._along_lines()) if is_name else [])])
        own = self._pixels([point.place])
        for offset, across, up in places:
            label = self._annotated(point, text, offset, across, up, 7.5 if is_name else 8.5)
            box = label.get_window_extent()
            apart = max(APART * self._pixel, FARTHER[is_name] * float(_distances(box, own)[0]))
            if (_distances(box, others) > apart).all() and self._is_free(box, lines):
                self.taken.append(box)
                return True
            label.remove()
        return False

    def _is_free(self, box: Bbox, lines: np.ndarray) -> bool:
        """Whether a rectangle is inside the panel and covers no label or line."""
        wide = box.padded(GAP * self._pixel)
        inside = self.panel.get_window_extent()
        if any(wide.overlaps(other) for other in self.taken) or any(wide.contains(*each) for each in lines):
            return False
        return all(inside.contains(*corner) for corner in wide.corners())

    def _annotated(
        self, point: Labelled, text: str, offset: tuple[float, float], across: str, up: str, size: float
    ) -> Annotation:
        """The text, at an offset in points."""
        looks: dict[str, Any] = {"ha": across, "va": up, "color": point.colour, "parse_math": False}
        looks |= {"fontsize": size + 1.0, "fontweight": "bold"} if point.is_bold else {"fontsize": size}
        looks["path_effects"] = [withStroke(linewidth=2.5, foreground="white")]
        return self.panel.annotate(text, point.place, offset, textcoords="offset points", **looks)

    def _along_lines(self) -> Iterator[np.ndarray]:
        """Places along the lines, in pixels."""
        for line in self.lines:
            for first, last in pairwise(self._pixels(line)):
                count = 2 + int(np.hypot(*(last - first)) / (STEP * self._pixel))
                yield first + np.linspace(0.0, 1.0, count)[:, None] * (last - first)

    def _pixels(self, places: Sequence[tuple[float, float]] | np.ndarray) -> np.ndarray:
        """Places in pixels (k, 2)."""
        return np.asarray(self.panel.transData.transform(np.reshape(places, (-1, 2))))

    @property
    def _pixel(self) -> float:
        """Pixels of a point, 1/72 of an inch."""
        return float(self.panel.figure.dpi) / 72.0


def _distances(box: Bbox, points: np.ndarray) -> np.ndarray:
    """Distances of points (k, 2) from a rectangle, 0 inside."""
    low, high = np.array([box.min, box.max])
    return np.asarray(np.hypot(*np.maximum(np.maximum(low - points, points - high), 0.0).T))

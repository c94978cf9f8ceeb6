"""The line of a joint in a body: distances from it, and the faces that disks beside it have on it."""

from collections.abc import Mapping

import numpy as np

from dembound.casefile.disks.joint import CORNERS
from dembound.disks.faces.cells import intervals
from dembound.table import Box


class Line:
    """A polyline of points (k, 2) m in a box, of which ends outside are cut off; ``length`` (m) is what is left.

    ends : m, how far from some sides it ends. open : whether each end is at a side, or on another joint; held : whether
    it is on one; ended_at : the side before which each ends, or empty.
    """

    def __init__(self, points: np.ndarray, box: Box, ends: Mapping[str, float]) -> None:
        near = [ends.get(side, 0.0) for side in CORNERS]
        inner = box[0] + near[0], box[1] + near[1], box[2] - near[2], box[3] - near[3]
        outer = [not is_inside(point, inner) for point in points[[0, -1]]]
        each = zip(outer, points[[1, -2]], points[[0, -1]], strict=True)
        first, last = (entry(inside, end, inner) if out else end for out, inside, end in each)
        self.held = [False, False]
        self.open = [out and not is_inside(end, box) for out, end in zip(outer, (first, last), strict=True)]
        self.ended_at = [
            CORNERS[int(np.abs(end[[0, 1, 0, 1]] - inner).argmin())] if out and not is_open else ""
            for out, is_open, end in zip(outer, self.open, (first, last), strict=True)
        ]
        self.points = np.vstack([first, points[1:-1], last])
        steps = np.diff(self.points, axis=0)
        self.lengths = np.hypot(*steps.T)
        self.along = steps / np.maximum(self.lengths, 1e-300)[:, None]  # 0 where all of it is cut off
        self.begins = np.concatenate([[0.0], np.cumsum(self.lengths)])
        self.length = float(self.begins[-1])

    def nearest(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance to the left (n,) m and place along the line (n,) m of the segment nearest to positions (n, 2) m.

        Places are negative before its beginning, and go on beyond its end. Beyond an end at a
        side of the body the joint goes on.
        """
        least, found = np.full(len(positions), np.inf), np.zeros((2, len(positions)))
        for number, (start, along, length) in enumerate(zip(self.points, self.along, self.lengths, strict=False)):
            x, y = (positions - start).T
            place, left = x * along[0] + y * along[1], y * along[0] - x * along[1]
            past = np.hypot(left, place - np.clip(place, 0.0, length))
            nearer = past < least
            least = np.where(nearer, past, least)
            low = 0.0 if number > 0 else -np.inf
            high = length if number < len(self.lengths) - 1 else np.inf
            on_line = self.begins[number] + np.clip(place, low, high)
            found = np.where(nearer, np.stack([left, on_line]), found)
        left, here = found
        tiny = 1e-6 * self.length
        here = np.maximum(here, tiny) if self.open[0] else here
        here = np.minimum(here, self.length - tiny) if self.open[1] else here
        return left, here

    def faces(
        self, disks: np.ndarray, side: np.ndarray, positions: np.ndarray, radii: np.ndarray
    ) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Disk (f,), ends (f, 2, 2) m and direction (f, 2) of the faces of one side's disks (k,) on each segment.

        side : (n,), see `Faces`; disks without a side limit the cells of others, and have no faces.
        """
        found = []
        for number, (start, along, length) in enumerate(zip(self.points, self.along, self.lengths, strict=False)):
            x, y = (positions[disks] - start).T
            place, left = x * along[0] + y * along[1], y * along[0] - x * along[1]
            low, high = intervals(place, left, radii[disks])
            if number > 0 or self.open[0]:
                low = np.maximum(low, 0.0)
            if number < len(self.lengths) - 1 or self.open[1]:
                high = np.minimum(high, length)
            chosen = np.flatnonzero((high > low) & (side[disks] != 0))
            near = 2.0 * float(radii.max())  # up to another joint there are no gaps
            if len(chosen) and number == 0 and self.held[0] and low[chosen].min() < near:
                low[chosen[low[chosen].argmin()]] = 0.0
            if len(chosen) and number == len(self.lengths) - 1 and self.held[1] and high[chosen].max() > length - near:
                high[chosen[high[chosen].argmax()]] = length
            chosen = chosen[np.argsort(low[chosen], kind="stable")]
            ends = start + np.stack([low, high], axis=1)[chosen, :, None] * along
            found.append((disks[chosen], ends, np.repeat(along[None], len(chosen), axis=0)))
        return found


def is_inside(point: np.ndarray, box: Box) -> bool:
    """Whether a point (2,) m lies in a box, not on its sides."""
    left, bottom, right, top = box
    near = 1e-9 * max(right - left, top - bottom)
    return bool(left + near < point[0] < right - near and bottom + near < point[1] < top - near)


def entry(inside: np.ndarray, outside: np.ndarray, box: Box) -> np.ndarray:
    """Where the line from a point (2,) m to one outside of the box leaves it; from outside, that where it goes in."""
    low, high, step = np.array(box[:2]), np.array(box[2:]), outside - inside
    with np.errstate(divide="ignore", invalid="ignore"):
        limits = np.where(step > 0.0, (high - inside) / step, np.where(step < 0.0, (low - inside) / step, np.inf))
    found: np.ndarray = inside + np.clip(limits.min(), 0.0, 1.0) * step
    return found

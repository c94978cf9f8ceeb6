"""Outlines of holes: closed curves, run through counter-clockwise by a parameter of a given period.

The ground is on their right. On a piece from A to B, whatever its shape, a pressure p on the ground has the force and
the moment about a point c

    ∫ p n ds = p (B_y − A_y, A_x − B_x),   ∫ (x − c) × p n ds = −½ p (|B − c|² − |A − c|²),

as n ds = (dy, −dx). Over a closed curve both are zero.
"""

from abc import ABC, abstractmethod

import numpy as np

ITERATIONS = 20
"""Number of Newton steps for the nearest point of an ellipse.

8 reach rounding errors for axes of 1 to 10, 16 for 1 to 1000.
"""

ROUNDING = 1e-9
"""Distance over the size of an outline up to which a place is on a line."""


class Outline(ABC):
    """A closed curve.

    Attributes
    ----------
    period : by which the parameter grows in one round.
    """

    period: float

    @abstractmethod
    def at(self, parameter: np.ndarray) -> np.ndarray:
        """Points (k, 2) m at parameters (k,) of any size."""

    @abstractmethod
    def nearest(self, places: np.ndarray) -> np.ndarray:
        """Parameters (k,) of the points nearest to places (k, 2) m, from 0 to the period."""

    @abstractmethod
    def crossings(self, axis: int, level: float) -> np.ndarray:
        """Parameters (k,) of points whose coordinate along an axis is `level` (m), where the curve may cross."""

    def within(self, box: tuple[float, float, float, float]) -> list[tuple[float, float]]:
        """The parts that lie within a box (left, bottom, right, top; m): where they begin, and how long they are.

        Both are in parameters; a whole curve begins at 0 and is as long as the period. Parts along a side of the box
        are not within it.
        """
        levels = ((0, box[0]), (0, box[2]), (1, box[1]), (1, box[3]))
        cuts = np.unique(np.concatenate([self.crossings(axis, level) for axis, level in levels]) % self.period)
        if len(cuts) == 0:
            return [(0.0, self.period)] if self._is_inside(np.zeros(1), box)[0] else []
        lengths = np.diff(cuts, append=cuts[0] + self.period)
        inside = self._is_inside(cuts + 0.5 * lengths, box)
        if inside.all():
            return [(0.0, self.period)]
        first = int(np.argmin(inside))  # after this one, which is outside, no part goes on from the end to the start
        parts: list[tuple[float, float]] = []
        goes_on = False
        for each in np.roll(np.arange(len(cuts)), -first):
            if inside[each] and goes_on:
                parts[-1] = parts[-1][0], parts[-1][1] + float(lengths[each])
            elif inside[each]:
                parts.append((float(cuts[each]), float(lengths[each])))
            goes_on = bool(inside[each])
        return parts

    def beyond(self, parameter: np.ndarray, part: tuple[float, float]) -> np.ndarray:
        """Distances of parameters (k,) from a part of the outline (begin and length), in parameters; 0 within."""
        along = (parameter - part[0]) % self.period
        return np.where(along <= part[1], 0.0, np.minimum(along - part[1], self.period - along))

    def _is_inside(self, parameter: np.ndarray, box: tuple[float, float, float, float]) -> np.ndarray:
        """Mask (k,) of points that lie within a box, and not on one of its sides."""
        points = self.at(parameter)
        near = ROUNDING * np.ptp(self.at(np.linspace(0.0, self.period, 8, endpoint=False)), axis=0).max()
        inside: np.ndarray = ((points > np.array(box[:2]) + near) & (points < np.array(box[2:]) - near)).all(axis=1)
        return inside


class EllipseOutline(Outline):
    """An ellipse; its parameter is the eccentric angle from the first semi-axis, for a circle the angle.

    Parameters
    ----------
    centre : m. semi_axes : m. angle : rad, from the x axis to the first semi-axis.
    """

    period = 2.0 * np.pi

    def __init__(self, centre: tuple[float, float], semi_axes: tuple[float, float], angle: float = 0.0) -> None:
        self._centre, self._axes = np.array(centre), np.array(semi_axes)
        c, s = np.cos(angle), np.sin(angle)
        self._turn = np.array([[c, s], [-s, c]])  # of rows (x, y) along the semi-axes to rows along x and y

    def at(self, parameter: np.ndarray) -> np.ndarray:
        """Points (k, 2) m at eccentric angles (k,)."""
        circle = np.stack([np.cos(parameter), np.sin(parameter)], axis=-1)
        points: np.ndarray = self._centre + (circle * self._axes) @ self._turn
        return points

    def nearest(self, places: np.ndarray) -> np.ndarray:
        """Eccentric angles (k,) of the points nearest to places (k, 2) m.

        Each step takes the point whose centre of curvature lies in the direction of the place: exact for a circle.
        """
        own = (places - self._centre) @ self._turn.T
        sign, place = np.where(own < 0.0, -1.0, 1.0), np.abs(own)
        direction = np.full_like(place, np.sqrt(0.5))
        a, b = self._axes
        evolute = np.array([a * a - b * b, b * b - a * a]) / self._axes
        for _ in range(ITERATIONS):
            point, curved = direction * self._axes, evolute * direction**3
            radius, away = np.hypot(*(point - curved).T), place - curved
            away *= (radius / np.maximum(np.hypot(*away.T), np.finfo(float).tiny))[:, None]
            direction = np.clip((curved + away) / self._axes, 0.0, 1.0)
            direction /= np.hypot(*direction.T)[:, None]
        angles: np.ndarray = np.arctan2(sign[:, 1] * direction[:, 1], sign[:, 0] * direction[:, 0]) % self.period
        return angles

    def crossings(self, axis: int, level: float) -> np.ndarray:
        """Eccentric angles (k,) of points whose coordinate along an axis is `level` (m)."""
        along = self._axes * self._turn[:, axis]
        most, first = np.hypot(*along), np.arctan2(along[1], along[0])
        part = (level - self._centre[axis]) / most
        return first + np.arccos(part) * np.array([-1.0, 1.0]) if abs(part) < 1.0 else np.zeros(0)


class PolygonOutline(Outline):
    """Straight edges; the parameter is the length (m) from the first corner.

    Parameters
    ----------
    corners : (n, 2) m, in either order.
    """

    def __init__(self, corners: np.ndarray) -> None:
        corners = np.asarray(corners, dtype=float)
        x, y = corners.T
        if np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) < 0.0:
            corners = corners[::-1]
        edges = np.roll(corners, -1, axis=0) - corners
        there = np.hypot(*edges.T) > 0.0
        self.corners, self._edges = corners[there], edges[there]
        self._lengths = np.hypot(*self._edges.T)
        self._starts = np.concatenate([[0.0], np.cumsum(self._lengths)])
        self.period = float(self._starts[-1])

    def at(self, parameter: np.ndarray) -> np.ndarray:
        """Points (k, 2) m at lengths (k,) m."""
        along = parameter % self.period
        closed = np.vstack([self.corners, self.corners[:1]])
        return np.stack([np.interp(along, self._starts, closed[:, axis]) for axis in (0, 1)], axis=-1)

    def nearest(self, places: np.ndarray) -> np.ndarray:
        """Lengths (k,) m of the points nearest to places (k, 2) m.

        Between equally near points of two edges that meet, their corner or what is in the middle; else the first.
        """
        edges, lengths, disks = self._edges[:, None], self._lengths[:, None], np.arange(len(places))
        from_corners = places - self.corners[:, None]
        parts = np.clip((from_corners * edges).sum(axis=2) / lengths**2, 0.0, 1.0)
        distance = np.hypot(*np.moveaxis(from_corners - parts[:, :, None] * edges, 2, 0))
        equal = distance <= distance.min(axis=0) + ROUNDING * self.period
        first, last = np.argmax(equal, axis=0), len(edges) - 1 - np.argmax(equal[::-1], axis=0)
        is_round = last - first == len(edges) - 1  # the last edge and the first one
        last = np.where(is_round | (last == first + 1), last, first)
        along = self._starts[:-1, None] + parts * lengths
        middle: np.ndarray = 0.5 * (along[first, disks] + along[last, disks] + is_round * self.period)
        return middle % self.period

    def crossings(self, axis: int, level: float) -> np.ndarray:
        """Lengths (k,) m of points whose coordinate along an axis is `level` (m); both ends of edges on this line."""
        begin, end = self.corners[:, axis] - level, np.roll(self.corners[:, axis], -1) - level
        crosses = np.flatnonzero(begin * end < 0.0)
        part = begin[crosses] / (begin - end)[crosses]
        between = self._starts[crosses] + self._lengths[crosses] * part
        return np.concatenate([between, self._starts[:-1][begin == 0.0]])

    @property
    def crosses_itself(self) -> bool:
        """Whether two edges that are not neighbours meet, so that inside and outside are not defined."""
        count = len(self.corners)
        first, second = np.triu_indices(count, 2)
        apart = ~((first == 0) & (second == count - 1))
        first, second = first[apart], second[apart]
        p, q, r, s = self.corners[first], self._edges[first], self.corners[second], self._edges[second]
        ends = [_sides(q, r - p), _sides(q, r + s - p), _sides(s, p - r), _sides(s, p + q - r)]
        meets: bool = bool(((ends[0] * ends[1] <= 0.0) & (ends[2] * ends[3] <= 0.0) & _overlap(p, q, r, s)).any())
        return meets


def _sides(edge: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Sign (k,) of the side of edges (k, 2) on which places (k, 2) relative to their starts lie."""
    return np.sign(edge[:, 0] * place[:, 1] - edge[:, 1] * place[:, 0])


def _overlap(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Whether the rectangles round edges from p along q and from r along s overlap or touch, (k,); all (k, 2) m."""
    low = np.maximum(np.minimum(p, p + q), np.minimum(r, r + s))
    high = np.minimum(np.maximum(p, p + q), np.maximum(r, r + s))
    overlap: np.ndarray = (low <= high).all(axis=1)
    return overlap

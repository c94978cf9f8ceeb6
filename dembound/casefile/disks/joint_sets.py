"""The ``[[joint]]`` tables of a file: single lines, and sets of parallel ones; lines that cross others end at them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import field_validator

from dembound.boundaries.boundary import Boundary
from dembound.casefile.disks.joint import APART, Joint, JointKeys, a_line, distance_to, goes_on
from dembound.casefile.messages import numbered
from dembound.holes.hole import Hole
from dembound.holes.polygon import Points
from dembound.table import LARGEST_WHOLE, Box, quantity

MOST_LINES = 1000
"""Largest number of lines of a set."""

LEAST_ANGLE = 30.0
"""Angle (degrees) from which on a line ends at one that it crosses; below it too few disks lie between them."""

FINE = 16
"""Places per diameter at which distances from other lines are looked at."""

DIGITS = 9
"""Digits after the point of the places of a set, m."""

OF_SETS = ("spacing", "persistence", "trace", "region", "seed")


class JointTable(JointKeys):
    """A plane of weakness, a line whose two faces are joined by springs; or a set of parallel lines.

    A set `NAME` becomes the joints `NAME_1`, `NAME_2` and so on.
    """

    points: Points | None = quantity(None, unit="m", means="place")
    """the line: points [[x, y], …], with kinks of up to 10°; or give dip"""
    dip: float | None = quantity(None, unit="degrees", means="direction", ge=-90.0, le=90.0)
    """of a set: angle below the horizontal, falling towards +x"""
    spacing: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """distance from one line of a set to the next, across them"""
    persistence: float = quantity(1.0, means="share", gt=0.0, le=1.0)
    """share of the lines of a set that is cut; the rest is rock"""
    trace: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """mean length of the cuts"""
    region: Box | Points | None = quantity(None, unit="m", means="place")
    """where a set is: [x0, y0, x1, y1], or corners of a polygon; absent: everywhere"""
    seed: int = quantity(0, means="count", ge=0, le=LARGEST_WHOLE)
    """seed of the places of a set"""

    def mistakes(self) -> Iterator[str]:
        """Neither a line nor a set, or keys of the one or the other."""
        yield from super().mistakes()
        if self.dip is None:
            if self.points is None:
                yield "points: is missing; give it, or dip"
            yield from (f"{key}: is for a set; give dip, too" for key in OF_SETS if key in self.model_fields_set)
        else:
            if self.points is not None:
                yield "points: is not allowed together with dip"
            if self.spacing is None:
                yield "spacing: is missing; a set needs it"
            if self.persistence < 1.0 and self.trace is None:
                yield "trace: is missing; bridges need it"
            if self.persistence == 1.0 and self.trace:
                yield "trace: needs persistence below 1"
        if self.corners is not None and len(self.corners) < 3:
            yield "region: must be a box or at least three corners"

    @field_validator("points")
    @classmethod
    def _is_a_line(cls, points: Points | None) -> Points | None:
        return points if points is None else a_line(points)

    @property
    def corners(self) -> np.ndarray | None:
        """Corners (k, 2) m of the region; None for all of the ground."""
        if self.region is None:
            return None
        corners = np.array(self.region)
        return corners_of(corners) if corners.ndim == 1 else corners

    @property
    def bridge(self) -> float | None:
        """Mean length (m) of bridges; None without any."""
        return None if self.trace is None else self.trace * (1.0 - self.persistence) / self.persistence

    def line(self, points: np.ndarray, number: int = 0, left_out: float = 0.0) -> Joint:
        """The joint along points (k, 2) m; number, left_out : see `Joint`, number 0 for a single line."""
        own = {key: getattr(self, key) for key in JointKeys.model_fields if key in self.model_fields_set}
        name = f"{self.name}_{number}" if number else self.name
        joint = Joint(**own | {"name": name, "points": tuple(map(tuple, points.tolist()))})
        joint._left_out, joint._is_of_set = left_out if number == 1 else 0.0, self.dip is not None
        return joint


class _Path:
    """A line of points (k, 2) m with places at distances along it; length, m."""

    def __init__(self, points: np.ndarray) -> None:
        self.points = points
        self.begins = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        self.length = float(self.begins[-1])

    def at(self, along: np.ndarray) -> np.ndarray:
        """Places (k, 2) m at distances (k,) m."""
        return np.stack([np.interp(along, self.begins, column) for column in self.points.T], axis=1)

    def part(self, low: float, high: float) -> np.ndarray:
        """Points (l, 2) m from one distance (m) to another."""
        inner = self.points[(self.begins > low) & (self.begins < high)]
        return np.vstack([self.at(np.array([low])), inner, self.at(np.array([high]))])

    def crossings(self, other: np.ndarray, near: float) -> Iterator[float]:
        """Distances (m) at which another line (l, 2) m is met at `LEAST_ANGLE` or more; near : m, short of it."""
        for (a, b), begin in zip(pairwise(self.points), self.begins[:-1], strict=True):
            for c, d in pairwise(other):
                (ux, uy), (vx, vy), (wx, wy) = b - a, d - c, c - a
                size, cross = math.hypot(ux, uy), ux * vy - uy * vx
                if abs(cross) < math.sin(math.radians(LEAST_ANGLE)) * size * math.hypot(vx, vy) * (1.0 - 1e-9):
                    continue
                along, place = (wx * vy - wy * vx) / cross, (wx * uy - wy * ux) / cross
                slack = near / size, near / math.hypot(vx, vy)
                if -slack[0] <= along <= 1.0 + slack[0] and -slack[1] <= place <= 1.0 + slack[1]:
                    yield float(begin + np.clip(along, 0.0, 1.0) * size)


def without_sets(tables: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The tables of a case with single joints in place of sets and of lines that cross others, and their mistakes.

    Tables and entries that are invalid on their own are None, and so are sets in ground that is therefore not known.
    """
    joints, problems, known = list[Joint | None](), list[str](), list[tuple[str, np.ndarray]]()
    is_known = tables["packing"] and tables["ground"] and None not in (*tables["hole"], *tables["boundary"].values())
    for place, table in numbered("joint", tables["joint"]):
        if not is_known:
            joints.append(None if table.points is None else table.line(np.array(table.points)))
            continue
        lines, left_out, wrong = (_set if table.points is None else _single)(table, tables, known)
        problems += [f"{place}.{wrong}"] if wrong else []
        is_single = table.points is not None and len(lines) == 1
        joints += [table.line(line, 0 if is_single else k, left_out) for k, line in enumerate(lines, start=1)] or [None]
        known += [(place, line) for line in lines]
    return {**tables, "joint": tuple(joints)}, problems


Earlier = Sequence[tuple[str, np.ndarray]]
"""The lines (k, 2) m of earlier tables, each with the place of its table."""


def _single(table: JointTable, tables: Mapping[str, Any], earlier: Earlier) -> tuple[list[np.ndarray], float, str]:
    """The parts (k, 2) m of a line that crosses earlier ones, 0, and its mistake."""
    path, least = _Path(np.array(table.points)), APART * 2.0 * tables["packing"].radius
    parts, lost = _apart(path, [line for _, line in earlier], least)
    if lost == 0.0:
        return [path.part(*each) for each in parts], 0.0, ""
    near = [each for each, line in earlier if distance_to(path.at(_fine(path, least)), line).min() < least]
    return (
        [],
        0.0,
        (
            f"points: comes within three diameters of the disks, {least:g} m, of {near[0]}; must stay away, or cross "
            f"it at {LEAST_ANGLE:g}° or more and end three diameters from it"
        ),
    )


def _set(table: JointTable, tables: Mapping[str, Any], earlier: Earlier) -> tuple[list[np.ndarray], float, str]:
    """The lines (2, 2) m of a set, how many metres of it are left out beside earlier ones, and its mistake."""
    packing, others = tables["packing"], [line for _, line in earlier]
    fine, least = 2.0 * packing.radius / FINE, APART * 2.0 * packing.radius
    for key, length, times, what in (
        ("spacing", table.spacing, 1, "is"),
        ("trace", table.trace, 2, "is"),
        ("persistence", table.bridge, 2, "makes bridges of"),
    ):
        if length is not None and length < times * least * (1.0 - 1e-9):
            needed = f"{('three', 'six')[times - 1]} diameters of the disks, {times * least:g} m, or more"
            return [], 0.0, f"{key}: {what} {length:.4g}, must be {needed}"
    air = tables["ground"].above(packing.box)
    holes = [*tables["hole"], *([] if air is None else [air])]
    found, left_out = list[np.ndarray](), 0.0
    for trace in _traces(table, _room(packing.box, tables["boundary"], 2.0 * packing.radius)):
        path = _Path(trace)
        parts, lost = _apart(path, others, least)
        left_out += lost
        for low, high in parts:
            if _solid(path.at(np.arange(low, high, fine)), packing.box, holes).sum() * fine >= least * (1.0 - 1e-9):
                found.append(np.round(path.part(low, high), DIGITS))
        if len(found) > MOST_LINES:
            return [], 0.0, f"spacing: makes more than {MOST_LINES:,} lines; give a larger one"
    none = f"spacing: no line of three diameters of the disks, {least:g} m, is in the ground and away from others"
    return found, left_out, "" if found else none


def _room(box: Box, boundary: Mapping[str, Boundary], diameter: float) -> np.ndarray:
    """Corners (4, 2) m of a box, smaller by `APART` at sides where the ground goes on, larger by twice that at others.

    There lines end at each other outside of the ground, too, so that they have no ends beside it.
    """
    beyond = [
        (-1.0 if side in boundary and goes_on(boundary[side]) else 2.0) * APART * diameter
        for side in ("left", "bottom", "right", "top")
    ]
    return corners_of(np.array(box) + np.array([-1.0, -1.0, 1.0, 1.0]) * beyond)


def corners_of(box: np.ndarray) -> np.ndarray:
    """Corners (4, 2) m of a box (4,): left, bottom, right, top."""
    return box[[[0, 1], [2, 1], [2, 3], [0, 3]]]


def _traces(table: JointTable, room: np.ndarray) -> Iterator[np.ndarray]:
    """The cuts (2, 2) m of a set, line by line; room : corners (4, 2) m of where they may be."""
    assert table.dip is not None
    assert table.spacing is not None
    region, dip = room if table.corners is None else table.corners, math.radians(table.dip)
    draw = np.random.default_rng(table.seed)
    along, across = np.array([math.cos(dip), -math.sin(dip)]), np.array([math.sin(dip), math.cos(dip)])
    low, high = (region @ across).min(), (region @ across).max()
    begin, end = float((region @ along).min()), float((region @ along).max())
    for height in np.arange(low + table.spacing * draw.random(), high, table.spacing).tolist():
        spans = [_inside(area @ along, area @ across, height) for area in (region, room)]
        cuts = [(begin, end)] if table.trace is None else list(_cuts(table, begin, end, draw))
        for both in _common(_common(cuts, spans[0]), spans[1]):
            yield np.stack([height * across + place * along for place in both])


def _cuts(table: JointTable, begin: float, end: float, draw: np.random.Generator) -> Iterator[tuple[float, float]]:
    """Cuts between two places (m) on a line, which begin anywhere."""
    trace, bridge = table.trace or 0.0, table.bridge or 0.0
    place = begin - (trace + bridge) * draw.random()
    while place < end:
        cut = trace * (0.5 + draw.random())
        yield place, place + cut
        place += cut + bridge * (0.5 + draw.random())


def _inside(along: np.ndarray, across: np.ndarray, height: float) -> list[tuple[float, float]]:
    """Where the line at a height (m) across is inside the polygon of corners at (k,) m along and across."""
    following = np.roll(along, -1), np.roll(across, -1)
    meets = (across > height) != (following[1] > height)
    share = (height - across[meets]) / (following[1] - across)[meets]
    places = np.sort(along[meets] + share * (following[0] - along)[meets]).tolist()
    return list(zip(places[::2], places[1::2], strict=True))


def _common(one: Sequence[tuple[float, float]], other: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """The parts that two lists of ranges share."""
    both = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return [(low, high) for low, high in both if low < high]


def _solid(places: np.ndarray, box: Box, holes: Sequence[Hole]) -> np.ndarray:
    """Whether places (k, 2) m are in the ground."""
    (left, bottom, right, top), (x, y) = box, places.T
    inside = (x > left) & (x < right) & (y > bottom) & (y < top)
    for hole in holes:
        inside &= ~hole.takes(places, span=0.0)
    return inside


def _fine(path: _Path, least: float) -> np.ndarray:
    """Distances (k,) m along a path at which others are looked at."""
    return np.linspace(0.0, path.length, math.ceil(path.length * FINE * APART / least) + 1)


def _apart(path: _Path, others: Sequence[np.ndarray], least: float) -> tuple[list[tuple[float, float]], float]:
    """Parts of a path between distances (m) that end at others or stay away from them by `least` (m); metres lost.

    Short ends beyond a line that is crossed do not count as lost.
    """
    places = _fine(path, least)
    points = path.at(places)
    near = np.array([distance_to(points, other) < least * (1.0 - 1e-9) for other in others])
    near = near.reshape(len(others), len(places))
    stops: list[tuple[float, int | None]] = [(0.0, None), (path.length, None)]
    for number in np.flatnonzero(near.any(axis=1)).tolist():
        stops += [(place, number) for place in path.crossings(others[number], 1e-6 * least)]
    found, lost = list[tuple[float, float]](), 0.0
    for (low, at_low), (high, at_high) in pairwise(sorted(stops, key=lambda stop: stop[0])):
        inside = np.flatnonzero((places >= low) & (places <= high))
        parts = []
        for run in _runs(near[:, inside], at_low, at_high):
            first = low if run[0] == 0 else float(places[inside[run[0]]])
            last = high if run[-1] == len(inside) - 1 else float(places[inside[run[-1]]])
            parts += [(first, last)] if last - first >= least * (1.0 - 1e-9) or not others else []
        one_end = (at_low is None) != (at_high is None)
        if parts or not one_end or high - low > least / math.sin(math.radians(LEAST_ANGLE)):
            gone = high - low - sum(b - a for a, b in parts)
            lost += gone if gone > 1e-6 * least else 0.0
        found += parts
    return found, lost


def _runs(near: np.ndarray, at_low: int | None, at_high: int | None) -> Iterator[np.ndarray]:
    """Runs of places (k,) that may stay, from those that are near each other line (l, k) between two ends of a part.

    An end at another line may be near it; a run without this end may not.
    """
    blocked, count = near.copy(), near.shape[1]
    for number, way in ((at_low, 1), (at_high, -1)):
        if number is not None:
            row = blocked[number, ::way]
            row[: np.argmin(row) if not row.all() else count] = False
    away = np.asarray(~blocked.any(axis=0))
    for run in np.split(np.arange(count), np.flatnonzero(np.diff(away.astype(int))) + 1):
        if count == 0 or not away[run[0]]:
            continue
        reaches = run[0] == 0, run[-1] == count - 1
        for number, there in ((at_low, reaches[0]), (at_high, reaches[1])):
            if number is not None and not there:
                run = run[~near[number, run]]
        for number, there, far in ((at_low, reaches[0], -1), (at_high, reaches[1], 0)):
            if number is not None and there and len(run) and not all(reaches) and near[number, run[far]]:
                run = run[:0]
        if len(run):
            yield run

"""The ``[[joint]]`` tables: planes of weakness in the ground, and their mistakes."""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import PrivateAttr, field_validator

from dembound.boundaries.boundary import Boundary
from dembound.casefile.messages import numbered
from dembound.casefile.types import LAWS
from dembound.holes.polygon import Points
from dembound.table import FileName, Table, quantity

KINK = 10.0
"""Largest angle (degrees) between two segments of a joint."""

APART = 3.0
"""Least distance of two joints over the mean diameter."""

CORNERS = ("left", "bottom", "right", "top")
"""The sides in the order of a box."""

BRIDGE = 2
"""Disks, at least, between the end of a joint and a side beyond which the ground goes on."""

ALONG = 0.1
"""Sine of the angle up to which a line goes on along another."""

STRENGTH_KEYS = ("ten", "coh")
"""Keys of a joint's bonds, which need a friction that is left when they break."""


class JointKeys(Table):
    """The name of a joint, or of a set, and the constants of its faces."""

    name: FileName = quantity()
    """name; of a set without the numbers"""
    kn: float = quantity(unit="Pa/m", means="stiffness of a joint", gt=0.0)
    """normal stiffness per area"""
    ks: float = quantity(unit="Pa/m", means="stiffness of a joint", gt=0.0)
    """shear stiffness per area"""
    fric: float | None = quantity(None, means="friction coefficient", ge=0.0)
    """friction coefficient; absent: the joint stays closed, and does not slide"""
    ten: float = quantity(0.0, unit="Pa", means="strength", ge=0.0)
    """tensile strength"""
    coh: float = quantity(0.0, unit="Pa", means="strength", ge=0.0)
    """cohesion"""
    dilation: float = quantity(0.0, unit="degrees", means="direction", ge=0.0, lt=90.0)
    """angle at which faces that slide ride up on each other, below that of fric"""
    dilation_end: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """slip at which they rise no more; absent: at none"""
    dashpot: float = quantity(1.0, means="factor", ge=0.0, le=10.0)
    """normal dashpot of sliding faces, over ρ c_p of the ground"""

    def mistakes(self) -> Iterator[str]:
        """Strengths without a friction, and a dilation that it does not allow."""
        if self.fric is None and (given := [key for key in STRENGTH_KEYS if getattr(self, key) > 0.0]):
            yield f"{given[0]}: needs fric, the friction that is left once the joint has failed"
        if self.dilation > 0.0 and math.tan(math.radians(self.dilation)) >= (self.fric or 0.0):
            most = math.degrees(math.atan(self.fric or 0.0))
            yield f"dilation: is {self.dilation:g}, must be below the angle of fric, {most:.4g} (degrees)"
        if self.dilation_end is not None and self.dilation == 0.0:
            yield "dilation_end: needs dilation"

    @property
    def constants(self) -> tuple[object, ...]:
        """All but the name."""
        return tuple(getattr(self, key) for key in JointKeys.model_fields if key != "name")


class Joint(JointKeys):
    """A plane of weakness: a line whose two faces are joined by springs along all of it.

    In a file it may be one of a set, see `joint_sets.JointTable`.
    """

    points: Points = quantity(unit="m", means="place")
    """the line: points [[x, y], …] in order, two or more, with kinks of up to 10°"""

    _left_out: float = PrivateAttr(0.0)
    _is_of_set: bool = PrivateAttr(False)

    @field_validator("points")
    @classmethod
    def _is_a_line(cls, points: Points) -> Points:
        return a_line(points)

    @property
    def left_out(self) -> float:
        """Length (m) of the set of which it is the first joint that is left out beside earlier joints, else 0."""
        return self._left_out

    @property
    def is_of_set(self) -> bool:
        """Whether it is one of a set, of which there may be parts in the air."""
        return self._is_of_set

    @property
    def is_linear(self) -> bool:
        """Whether its faces neither part nor slide."""
        return self.fric is None


def joint_ends(boundary: Mapping[str, Boundary | None], intact: Mapping[str, int], diameter: float) -> dict[str, float]:
    """How far (m) before each side beyond which the ground goes on joints end, so that forces act on whole ground.

    One diameter (m) before the disks whose bonds do not break, of which there are `intact` from each side, or `BRIDGE`.
    """
    artificial = [side for side, table in boundary.items() if table and table.is_artificial]
    return {side: (1 + max(BRIDGE, intact.get(side, 0))) * diameter for side in artificial}


def a_line(points: Points) -> Points:
    """The points of a joint; raises ValueError for fewer than two, and for kinks above `KINK`."""
    steps = np.diff(np.array(points).reshape(-1, 2), axis=0)
    if len(steps) == 0 or not np.hypot(*steps.T).all():
        raise ValueError("must be two or more, none of them twice in turn")
    turns = np.degrees(np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))))
    if len(turns) and turns.max() > KINK + 1e-9:
        raise ValueError(f"turn by {turns.max():.3g}° at once, must turn by at most {KINK:g}°")
    return points


def joint_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the joints with all other tables; a table, or an entry, that is invalid on its own is None."""
    joints = dict(numbered("joint", tables["joint"]))
    if not joints:
        return
    place = next(iter(joints))
    yield from _taken_names(joints)
    if (material := tables["material"]) and (why := _unknown_law(material.law)):
        yield f"{place}: {why}"
    if any(hole and hole.stage == "run" for hole in tables["hole"]):
        yield f'{place}: is for ground whose holes are there before the run; let them have stage = "before" or "after"'
    if packing := tables["packing"]:
        for place, joint in joints.items():
            yield from _problems_at_sides(place, joint, packing.box, tables["boundary"])


def _taken_names(joints: Mapping[str, Joint]) -> Iterator[str]:
    """Names that two joints have."""
    first = dict[str, str]()
    for place, joint in joints.items():
        if first.setdefault(joint.name, place) != place:
            yield f'{place}.name: "{joint.name}" is taken by {first[joint.name]}'


def _unknown_law(name: str) -> str:
    """Why there are no joints under a contact law; empty if there are."""
    law = LAWS[name]
    if law.is_linear or (law.has_history and law.starts_elastic):
        return ""
    return f'is for contacts whose stiffness does not change; not for material.law = "{name}"'


def _problems_at_sides(
    place: str, joint: Joint, box: tuple[float, float, float, float], sides: Mapping[str, Boundary | None]
) -> Iterator[str]:
    """A joint that is not in the disks, or comes to a side where the ground goes on."""
    points, (left, bottom, right, top) = np.array(joint.points), box
    inside = [_crosses_box(one, other, box) for one, other in pairwise(points)]
    if not all(inside):
        corner = f"{left:g} <= x <= {right:g} and {bottom:g} <= y <= {top:g} (m)"
        yield f"{place}.points: a segment has no part in the disks, in {corner}"
        return
    low, high = points.min(axis=0), points.max(axis=0)
    reached = {"left": low[0] <= left, "right": high[0] >= right, "bottom": low[1] <= bottom, "top": high[1] >= top}
    for side, table in sides.items():
        if not (reached.get(side) and table) or not _leaves_by(points, side, box):
            continue
        if goes_on(table):
            said = "beyond which the ground goes on without it; let it end inside"
            yield f'{place}.points: reaches boundary.{side}, "{table.type}", {said}'


def goes_on(side: Boundary) -> bool:
    """Whether joints may not reach a side, as the ground goes on beyond it without them."""
    return side.is_periodic or side.is_mirror


def _leaves_by(points: np.ndarray, side: str, box: tuple[float, float, float, float]) -> bool:
    """Whether a line of points (k, 2) m meets a side of a box."""
    left, bottom, right, top = box
    corners = {
        "left": ((left, bottom), (left, top)),
        "right": ((right, bottom), (right, top)),
        "bottom": ((left, bottom), (right, bottom)),
        "top": ((left, top), (right, top)),
    }
    return _distance(points, np.array(corners[side])) == 0.0


def _crosses_box(one: np.ndarray, other: np.ndarray, box: tuple[float, float, float, float]) -> bool:
    """Whether a part of a segment between two points (2,) m lies in a box, by Liang's and Barsky's clipping."""
    low, high, step = 0.0, 1.0, other - one
    for axis in range(2):
        least, most = box[axis] - one[axis], box[axis + 2] - one[axis]
        if step[axis] == 0.0:
            if least >= 0.0 or most <= 0.0:
                return False
            continue
        first, last = sorted((least / step[axis], most / step[axis]))
        low, high = max(low, first), min(high, last)
    return low < high


def ends_on(points: np.ndarray, other: np.ndarray, near: float) -> np.ndarray:
    """Whether the first and the last of points (k, 2) m end on another line (l, 2) m, to 1e-6 of a length near (m).

    Not where both go on along each other, as the parts of a line that a third one has cut.
    """
    found = np.zeros(2, dtype=np.bool_)
    for number, (end, before) in enumerate((points[[0, 1]], points[[-1, -2]])):
        for segment in (pair for pair in pairwise(other) if distance_to(end[None], np.array(pair))[0] < 1e-6 * near):
            (ux, uy), (vx, vy) = end - before, segment[1] - segment[0]
            found[number] |= abs(ux * vy - uy * vx) > ALONG * math.hypot(ux, uy) * math.hypot(vx, vy)
    return found


def distance_to(places: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Distances (k,) m of places (k, 2) m from a line of points (l, 2) m."""
    least = np.full(len(places), np.inf)
    for one, other in pairwise(line):
        step = other - one
        part = np.clip((places - one) @ step / (step @ step), 0.0, 1.0)
        least = np.minimum(least, np.hypot(*(places - one - part[:, None] * step).T))
    return least


def _distance(one: np.ndarray, other: np.ndarray) -> float:
    """Least distance (m) of two lines of points (k, 2) m; 0 if they cross."""
    if any(_cross(a, b, c, d) for a, b in pairwise(one) for c, d in pairwise(other)):
        return 0.0
    return float(min(distance_to(one, other).min(), distance_to(other, one).min()))


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    """Whether the segments from a to b and from c to d have a point in common that is an end of none."""
    return _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0


def _turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    """Twice the area (m²) of a triangle, positive if its corners go round to the left."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

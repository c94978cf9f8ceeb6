"""The ``[[joint]]`` tables: planes of weakness in the ground, and their mistakes."""

import math
from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise
from typing import Any

import numpy as np
from pydantic import model_validator

from dembound.boundaries.boundary import Boundary
from dembound.casefile.messages import numbered
from dembound.casefile.types import LAWS
from dembound.table import FileName, Table, quantity

KINK = 10.0
"""Largest angle (degrees) between two segments of a joint."""

APART = 3.0
"""Least distance of two joints over the mean diameter."""

CORNERS = ("left", "bottom", "right", "top")
"""The sides in the order of a box."""

BRIDGE = 2
"""Disks, at least, between the end of a joint and a side beyond which the ground goes on."""

STRENGTH_KEYS = ("ten", "coh")
"""Keys of a joint's bonds, which need a friction that is left when they break."""


class Joint(Table):
    """A plane of weakness: a line whose two faces are joined by springs along all of it.

    Without `fric` the faces neither part nor slide. With it they part where they are pulled by more than `ten`, and
    slide where the shear stress reaches `coh` + `fric` × the pressure; both strengths are then lost.
    """

    name: FileName = quantity(..., unit="1", help="name of the joint in messages and results")
    points: tuple[tuple[float, float], ...] = quantity(
        ..., unit="m", means="place", help="the line: points [[x, y], …] in order, two or more, with kinks of up to 10°"
    )
    kn: float = quantity(..., unit="Pa/m", means="stiffness of a joint", help="normal stiffness per area", gt=0.0)
    ks: float = quantity(..., unit="Pa/m", means="stiffness of a joint", help="shear stiffness per area", gt=0.0)
    fric: float | None = quantity(
        None,
        unit="1",
        means="friction coefficient",
        help="friction coefficient; absent: the joint stays closed, and does not slide",
        ge=0.0,
    )
    ten: float = quantity(0.0, unit="Pa", means="strength", help="tensile strength", ge=0.0)
    coh: float = quantity(0.0, unit="Pa", means="strength", help="cohesion", ge=0.0)
    dashpot: float = quantity(
        1.0, unit="1", means="factor", help="normal dashpot of sliding faces, over ρ c_p of the ground", ge=0.0, le=10.0
    )

    @model_validator(mode="after")
    def _is_a_line(self) -> "Joint":
        steps = np.diff(np.array(self.points).reshape(-1, 2), axis=0)
        if len(steps) == 0 or not np.hypot(*steps.T).all():
            raise ValueError("points: must be two or more, none of them twice in turn")
        turns = np.degrees(np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))))
        if len(turns) and turns.max() > KINK + 1e-9:
            raise ValueError(f"points: turn by {turns.max():.3g}° at once, must turn by at most {KINK:g}°")
        if self.fric is None and (given := [key for key in STRENGTH_KEYS if getattr(self, key) > 0.0]):
            raise ValueError(f"{given[0]}: needs fric, the friction that is left once the joint has failed")
        return self

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
        box, diameter = packing.box, 2.0 * packing.radius
        for place, joint in joints.items():
            yield from _problems_at_sides(place, joint, box, tables["boundary"])
        for (one, first), (other, second) in combinations(joints.items(), 2):
            apart = _distance(np.array(first.points), np.array(second.points))
            if apart < APART * diameter * (1.0 - 1e-9):
                how = "crosses" if apart == 0.0 else f"comes within {apart:.3g} m of"
                least = f"must be three diameters of the disks, {APART * diameter:g} m, away from it"
                yield f"{other}.points: {how} {one}; {least}"


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
        if table.is_periodic or table.is_mirror:
            said = "beyond which the ground goes on without it; let it end inside"
            yield f'{place}.points: reaches boundary.{side}, "{table.type}", {said}'


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


def _distance(one: np.ndarray, other: np.ndarray) -> float:
    """Least distance (m) of two lines of points (k, 2) m; 0 if they cross."""
    least = math.inf
    for a, b in pairwise(one):
        for c, d in pairwise(other):
            if _cross(a, b, c, d):
                return 0.0
            ends = (_from(p, c, d) for p in (a, b)), (_from(p, a, b) for p in (c, d))
            least = min(least, *ends[0], *ends[1])
    return least


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    """Whether the segments from a to b and from c to d have a point in common that is an end of none."""
    return _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0


def _turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    """Twice the area (m²) of a triangle, positive if its corners go round to the left."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _from(point: np.ndarray, one: np.ndarray, other: np.ndarray) -> float:
    """Distance (m) of a point from the segment between two others."""
    step = other - one
    part = np.clip((point - one) @ step / (step @ step), 0.0, 1.0)
    return float(np.hypot(*(point - one - part * step)))

"""The one rule for what lies on an edge, and for the nearest of several points where more than one may be."""

import math
from typing import Any

import numpy as np

EQUAL = 1e-6
"""Relative difference from the smallest distance up to which other distances count as equal to it.

Points that are equally near to a place are at least a diameter D apart, so the distance is D/2 or more, while
coordinates X are rounded to 1e-16 X: far less than 1e-6 D/2 in bodies of less than 1e8 diameters. It also covers the
rounding of places given with ten digits in bodies of 1e3 diameters."""


def nearest(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Numbers (k,) of the points (n, 2) m nearest to places (k, 2) m."""
    from scipy.spatial import cKDTree

    tree = cKDTree(points, compact_nodes=False, balanced_tree=False)  # several times as fast to make
    least, found = tree.query(places)
    found = np.asarray(found, dtype=np.int64)
    near = tree.query_ball_point(places, least * (1.0 + EQUAL))
    for k in np.flatnonzero([len(each) > 1 for each in near]):
        equal = np.array(near[k])
        x, y = points[equal].T
        x[y > y.min() + EQUAL * least[k]] = np.inf
        found[k] = equal[np.argmin(x)]
    return found


def nearest_number(value: float) -> int:
    """The whole number nearest to a value, half-way between two of them the smaller one."""
    return math.ceil(value - 0.5 * (1.0 + EQUAL))


ROUNDING = 1e-9
"""Distance over the size of the scene up to which a place is on an edge.

Coordinates X are rounded to some 1e-16 X, which is less in scenes that are nearer to the origin than 1e6 of their
sizes; of disks it is less than 1e-3 diameters in scenes of less than 1e6 diameters.
"""


def includes(depth: Any, span: float) -> Any:
    """Whether places are in an area or on its edge.

    depth : of a place from the edge inwards, negative outside, m; a number or an array. span : size of the scene, the
    larger of its width and height, m.
    """
    return depth >= -ROUNDING * span


def is_in_range(ends: tuple[float, float], along: Any, span: float) -> Any:
    """Whether coordinates (m), a number or an array, are between two ends (m) or at one of them; span as above."""
    return includes(np.minimum(along - ends[0], ends[1] - along), span)


def is_within(box: tuple[float, float, float, float], places: Any, span: float) -> Any:
    """Whether places, (2,) or (k, 2) m, are in a box left, bottom, right, top (m) or on its edge; span as above."""
    x, y = np.asarray(places).T
    return is_in_range((box[0], box[2]), x, span) & is_in_range((box[1], box[3]), y, span)


def spans_all(box: tuple[float, float, float, float], whole: tuple[float, float, float, float], axis: int) -> bool:
    """Whether a rectangle reaches from one end to the other of a scene, of this rectangle, along an axis; m."""
    ends, span = (box[axis], box[axis + 2]), max(whole[2] - whole[0], whole[3] - whole[1])
    return bool(is_in_range(ends, whole[axis], span) & is_in_range(ends, whole[axis + 2], span))

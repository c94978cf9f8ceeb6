"""The nearest of several points to a place, where more than one may be equally near.

Rounding of coordinates must not decide between them, nor the order in which they are numbered: both differ between
boxes of the same ground. The lowest of these points is taken, of several of that height the leftmost.
"""

import math

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

"""The one rule for what lies on an edge: ground, regions and ranges include their edges.

A disk centred on an edge remains beside a hole and in a sample, has the load of a region, and is held by a range. All
such places are compared by `includes`, so that neither the shape nor the side of an edge, nor rounding, decides, and
mirrored input has mirrored output. A plane between two layers is the upper one's, as each disk is in one layer alone.
"""

from typing import Any

import numpy as np

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

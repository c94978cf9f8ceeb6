"""Ways of waves through a scene: from where they start, over its sides, to its monitors.

All ways are straight, and their waves as fast as the fastest of the medium, so that nothing can arrive before these
times. A way over a side is straight to the mirror image of its end.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import is_far, normal_axis
from dembound.table import Box

PRECURSOR = 10.0
"""Argument z of Airy's function at which a precursor ends: Ai(z) is 1e-9 of Ai(0) at 9.6."""


@dataclass(frozen=True)
class Front:
    """The fastest waves of a medium of particles.

    In a row of particles a apart, ω = cq(1 − (qa)²/24): an impulse that has travelled s = ct has a front shaped like
    Airy's function of (x − s)/(sa²/8)^(1/3). Ahead of x = s it decays, to 1e-9 at ten times (sa²/8)^(1/3).

    Attributes
    ----------
    speed : m/s.
    grain : a, m: distance of neighbours; with peridynamic bonds that of a row with equal dispersion.
    """

    speed: float
    grain: float

    def reach(self, time: float) -> float:
        """Distance (m) beyond which there is no motion, to 1e-9, at a time (s) after its start; 0 before."""
        way = self.speed * max(time, 0.0)
        return way + PRECURSOR * float(np.cbrt(way * self.grain**2 / 8.0))


@dataclass(frozen=True)
class Source:
    """A source of motion.

    Attributes
    ----------
    box : x0, y0, x1, y1 in m, infinite along a driven side.
    start, over : s, begin and end of its motion; infinite if it never ends.
    slowest : m/s, of the waves it sends.
    is_local : whether it is confined to a place, and so does not move a free-field column in the same way.
    """

    box: Box
    start: float
    over: float
    slowest: float
    is_local: bool = False

    def distance(self, places: np.ndarray) -> np.ndarray:
        """Shortest way (k,) m to places (k, 2) m."""
        low, high = np.array(self.box[:2]), np.array(self.box[2:])
        return np.hypot(*np.maximum(np.maximum(low - places, places - high), 0.0).T)

    def distance_over(self, side: str, plane: float, places: np.ndarray) -> np.ndarray:
        """Shortest way (k,) m over a side, which is at `plane` m along its normal, to places (k, 2) m."""
        axis, box = normal_axis(side), list(self.box)
        edge = axis + 2 * is_far(side)
        box[edge] = min(box[edge], plane) if edge > 1 else max(box[edge], plane)
        image = places.copy()
        image[:, axis] = 2.0 * plane - image[:, axis]
        return Source((box[0], box[1], box[2], box[3]), self.start, self.over, self.slowest).distance(image)


def first_arrivals(sources: Sequence[Source], front: Front, places: np.ndarray) -> np.ndarray:
    """Times (k,) s before which no wave except precursors reaches places (k, 2) m; infinite without any source."""
    times = [source.start + source.distance(places) / front.speed for source in sources if front.speed > 0.0]
    return np.min(times, axis=0) if times else np.full(len(places), np.inf)


def plane_needed(side: str, sources: Sequence[Source], places: np.ndarray, front: Front, duration: float) -> float:
    """Place (m along its normal) of a side from which no reflection reaches places (k, 2) m within `duration` (s).

    Infinitely far inwards if no wave arrives at all.
    """
    axis, sign = normal_axis(side), 1.0 if is_far(side) else -1.0
    needed = -np.inf
    for source in sources:
        reach = front.reach(duration - source.start)
        low, high, at = source.box[1 - axis], source.box[3 - axis], places[:, 1 - axis]
        across = np.maximum(np.maximum(low - at, at - high), 0.0)
        there = np.sqrt(np.maximum(reach**2 - across**2, 0.0)) + sign * places[:, axis]
        nearest = sign * source.box[2 + axis if sign > 0.0 else axis]
        # the way over the plane is the one there and back, or only back from a source that extends beyond it
        planes = np.minimum(there, 0.5 * (there + nearest))[reach > across]
        needed = max(needed, float(planes.max(initial=-np.inf)))
    return sign * needed

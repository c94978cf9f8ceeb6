"""The static field of a force or hole beside elements; it varies over their distance, at any length of waves.

Measured in boxes of 3 to 36 m × 3 to 36 m of disks (D = 0.25, 0.5, 1 m, pattern A, ν = 0.25) round circles and squares
with half sides of 0.2 to 0.8 of the box's, under a pressure and in P and S waves of 4 Hz; with one to four elements a
side, of orders 3 to 6, at nine places, compared with 2.5 times larger boxes with finer elements. Of 214 errors with one
element a side under a pressure the median is 0.82 times the error given here, 90 % are 0.2 to 2.3 times.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from dembound.table import Box

FORCES = {3: 2.0, 4: 3.0, 5: 3.5, 6: 4.0}
"""By order: side of elements over their distance from a force, with errors of 0.1 %.

Elements with sides of 2.35 times the distance have errors of 0.15, 0.04, 0.013 and 0.010 %, which rise with the third
power of the side.
"""

HOLES = {3: 6e-2, 4: 2e-2, 5: 1e-2, 6: 4e-3}
"""By order: error beside elements as wide as a box round a hole under a pressure.

The error round circles is 0.75 times, round squares up to 1.8 times as large. The error with two elements a side is
smaller by 2 to the power of the order plus one.
"""

WIDER = 2.5
"""Power of the side with which this error grows where elements are wider than the box: 10 % at twice, 22 % at three
times its width.
"""

PASSED = 1.5
"""Error beside a hole which waves pass, over the scattered motion k L²/(gap + L): the wave number k times half the
length L of the hole, times the share of it that reaches the elements. The error falls with a power of the side that is
smaller by two. Largest errors round holes that S waves pass, with kL of 0.1 to 0.4 and L/(gap + L) of 0.2 to 0.8, are
0.5 to 1.5 times this value with one element a side (90 %), 0.4 to 1.1 times with two.
"""

TIES = 0.2
"""Part of the field of a hole under a pressure returned by ties at a distance d, over (D/d)²."""

INWARD, OUTWARD = 2, 4
"""Powers of the distance with which the error over the local motion under a pressure grows up to the elements and falls
beyond.
"""


class NearField(NamedTuple):
    """The field of one force or hole beside elements on one side of a box.

    place : the rectangle (m) of the hole, or a force's middle twice. gap : m, from there to the elements. source :
    the cause of the field: a pressure in a hole, waves that pass a hole, with an RMS wave number (1/m), or a force.
    """

    place: Box
    gap: float
    source: Literal["force", "pressure", "waves"]
    wave_number: float = 0.0

    @property
    def distance(self) -> float:
        """Distance (m) of elements from a force, or their gap to a hole plus half its shorter side."""
        return self.gap + 0.5 * min(self._sides)

    @property
    def _sides(self) -> tuple[float, float]:
        """The sides of the rectangle, m."""
        left, bottom, right, top = self.place
        return right - left, top - bottom

    def _widest(self, order: int) -> tuple[float, int]:
        """Error with elements as wide as a box round a hole, and the power of the side with which it falls."""
        if self.source == "pressure":
            return HOLES[order], order + 1
        half = 0.5 * max(self._sides)
        return HOLES[order] * min(PASSED * self.wave_number * half * half / (self.gap + half), 1.0), order - 1

    def error(self, order: int, side: float) -> float:
        """Error of the motion beside elements of a side (m), where it is largest; 0 for a force on them."""
        if self.distance == 0.0:
            return 0.0
        if self.source == "force":
            return 1e-3 * (side / (FORCES[order] * self.distance)) ** 3
        (largest, steep), width = self._widest(order), 0.5 * side / self.distance
        return largest * width ** (steep if width < 1.0 else WIDER)

    def largest_side(self, order: int, accuracy: float) -> float:
        """Largest side (m) of elements with this error, infinite for waves that do not vary: the inverse of `error`."""
        if self.source == "force":
            return FORCES[order] * self.distance * math.cbrt(1e3 * accuracy)
        largest, steep = self._widest(order)
        more = accuracy / largest if largest > 0.0 else math.inf
        return 2.0 * self.distance * more ** (1.0 / (steep if more < 1.0 else WIDER))

    def of_ties(self, diameter: float) -> float:
        """Error of the motion beside ties to disks of a mean diameter (m), where it is largest."""
        is_known = self.source == "pressure" and self.distance > 0.0
        return TIES * (diameter / self.distance) ** 2 if is_known else 0.0

    def part_at(self, place: np.ndarray) -> float:
        """The error at a place (2,) m over the largest error."""
        if self.source != "pressure" or self.distance == 0.0:
            return 1.0
        low, high = np.array(self.place[:2]), np.array(self.place[2:])
        away = float(np.maximum(low - place, place - high).max())
        way = max(0.5 * min(self._sides) + max(away, 0.0), 1e-9 * self.distance) / self.distance
        return way**INWARD if way < 1.0 else way**-OUTWARD

"""Displacements between the nodes of a mesh, and the static field of a force or hole beside elements."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from dembound.continuum.mesh import Mesh
from dembound.table import Box


class Interpolation(NamedTuple):
    """Interpolation of nodal displacements at k points: Σ weight·u over node, both (k, N²)."""

    node: np.ndarray
    weight: np.ndarray


def located(mesh: Mesh, points: np.ndarray, right: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The element (k,) of a mesh nearest to each of the points (k, 2) m, and their places (k, 2) in it, −1 … 1 inside.

    Above the free surface beside the box it is the highest element there, beyond periodic sides the element at the
    image. right : (k,) bool, whether it must be right of the slit of the mesh, if it has one; None: wherever the point
    is.
    """
    places = np.asarray(points) - mesh.origin
    places = np.where(mesh.periodic, places % mesh.size, places)
    column, row = (mesh.axes[a].cell_at(places[:, a]) for a in (0, 1))
    chosen = mesh.element_at[np.minimum(row, mesh.tops[column] - 1), column]
    in_box = chosen < 0
    chosen[in_box] = _nearest_to_box(mesh, places[in_box])
    if right is not None and mesh.slit:
        wrong = mesh.is_right[chosen] != right
        chosen[wrong] = _nearest_to_box(mesh, places[wrong], right[wrong])
    first = np.stack([mesh.axes[a].edges[mesh.elements[chosen, a]] for a in (0, 1)], axis=1)
    return chosen, 2.0 * (places - first) / mesh.element_sizes[chosen] - 1.0


def _nearest_to_box(mesh: Mesh, places: np.ndarray, right: np.ndarray | None = None) -> np.ndarray:
    """The element (k,) beside the box that is nearest to each of these places (k, 2) m from the origin.

    right : see `located`.
    """
    if mesh.box is None:
        return np.zeros(0, dtype=np.int64)
    near = (mesh.elements >= np.array(mesh.box[:2]) - 1) & (mesh.elements <= mesh.box[2:])
    beside = np.flatnonzero(near.all(axis=1))
    beyond = np.zeros((len(places), len(beside)))
    for a, axis in enumerate(mesh.axes):
        cell, place = mesh.elements[beside, a], places[:, a, None]
        beyond += np.maximum(np.maximum(axis.edges[cell] - place, place - axis.edges[cell + 1]), 0.0) ** 2
    if right is not None:
        beyond[mesh.is_right[beside] != right[:, None]] = np.inf
    return beside[np.argmin(beyond, axis=1)]


def interpolation(mesh: Mesh, points: np.ndarray) -> Interpolation:
    """The interpolation of nodal displacements at points (k, 2) m.

    Displacements of a point within no element are extrapolated from the nearest one.
    """
    chosen, local = located(mesh, points)
    x, y = (mesh.rule.shape(local[:, a]) for a in (0, 1))
    count = len(local)
    return Interpolation(mesh.nodes[chosen].reshape(count, -1), (y[:, :, None] * x[:, None, :]).reshape(count, -1))


def slopes(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """Derivatives (2, k, N²) along x and along y, 1/m, of the weights of `interpolation`."""
    chosen, local = located(mesh, points)
    (x, x_slope), (y, y_slope) = (
        (mesh.rule.shape(local[:, a]), mesh.rule.slope(local[:, a]) * (2.0 / mesh.element_sizes[chosen, a])[:, None])
        for a in (0, 1)
    )
    each = y[:, :, None] * x_slope[:, None, :], y_slope[:, :, None] * x[:, None, :]
    return np.stack(each).reshape(2, len(local), -1)


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

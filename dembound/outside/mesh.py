"""A mesh of equal rectangular spectral elements round a rectangular box, with absorbing elements at its sides."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dembound.outside.gll import Rule

WHOLE = 1e-9
"""Part of an element by which a box may miss its sides."""


class Around(NamedTuple):
    """Numbers of elements at the four sides."""

    left: int = 0
    right: int = 0
    bottom: int = 0
    top: int = 0

    def along(self, axis: int) -> tuple[int, int]:
        """Those before and after along x (axis 0) or y (1)."""
        return (self.left, self.right) if axis == 0 else (self.bottom, self.top)


NONE = Around()


class Interpolation(NamedTuple):
    """How displacements at k points follow from those of nodes: Σ weight·u over node, both (k, N²)."""

    node: np.ndarray
    weight: np.ndarray


@dataclass(frozen=True, eq=False, kw_only=True)
class Mesh:
    """Elements in columns and rows, without those inside a box.

    Nodes are the Gauss–Lobatto–Legendre points, N × N in an element, numbered row by row from the bottom, from left to
    right. The outer edges of absorbing layers are held at rest; all other edges are free.

    Attributes
    ----------
    order : of the elements, N − 1.
    element : width and height of an element, m.
    cells : number of columns and of rows.
    origin : lower left corner, m.
    box : first column, first row, and those after the last ones, of the elements left out; None: none.
    layer : how many of the columns and rows absorb at each side.
    periodic : whether the first column (row) follows the last one.
    """

    order: int
    element: tuple[float, float]
    cells: tuple[int, int]
    origin: tuple[float, float] = (0.0, 0.0)
    box: tuple[int, int, int, int] | None = None
    layer: Around = NONE
    periodic: tuple[bool, bool] = (False, False)

    def __post_init__(self) -> None:
        for axis in (0, 1):
            if self.periodic[axis] and any(self.layer.along(axis)):
                raise ValueError(f"a mesh that is periodic along axis {axis} has no absorbing layers there")
            if sum(self.layer.along(axis)) > self.cells[axis]:
                raise ValueError(f"layers have more elements along axis {axis} than the mesh, {self.cells[axis]}")

    @classmethod
    def around(
        cls,
        box: tuple[float, float, float, float],
        element: tuple[float, float],
        order: int = 4,
        *,
        margin: Around,
        layer: Around,
    ) -> "Mesh":
        """The mesh round a box (left, bottom, right, top; m), which may reach the free surface: no margin, no layer.

        margin, layer : elements at each side of the box without and with absorption.

        Raises ValueError unless the sides of the box are whole numbers of elements.
        """
        inside = []
        for axis, name in enumerate(("width", "height")):
            count = (box[2 + axis] - box[axis]) / element[axis]
            if abs(count - round(count)) > WHOLE or round(count) < 1:
                raise ValueError(f"the {name} of the box is {count:g} elements, must be a whole number of them")
            inside.append(round(count))
        before = [margin.along(axis)[0] + layer.along(axis)[0] for axis in (0, 1)]
        after = [margin.along(axis)[1] + layer.along(axis)[1] for axis in (0, 1)]
        left, bottom = before
        return cls(
            order=order,
            element=element,
            cells=(left + inside[0] + after[0], bottom + inside[1] + after[1]),
            origin=(box[0] - left * element[0], box[1] - bottom * element[1]),
            box=(left, bottom, left + inside[0], bottom + inside[1]),
            layer=layer,
        )

    @cached_property
    def rule(self) -> Rule:
        """The points of an element along each axis."""
        return Rule(self.order)

    @cached_property
    def elements(self) -> np.ndarray:
        """(E, 2) column and row of every element, row by row from the bottom."""
        kept = np.ones(self.cells[::-1], dtype=np.bool_)
        if self.box is not None:
            left, bottom, right, top = self.box
            kept[bottom:top, left:right] = False
        return np.argwhere(kept)[:, ::-1]

    def _lines(self, axis: int) -> int:
        """Number of lines of nodes across an axis."""
        return self.order * self.cells[axis] + (not self.periodic[axis])

    @cached_property
    def _element_lines(self) -> tuple[np.ndarray, np.ndarray]:
        """The lines through the points of every element along x and along y, (E, N) each."""
        lines = [self.order * self.elements[:, axis, None] + np.arange(self.order + 1) for axis in (0, 1)]
        return lines[0] % self._lines(0), lines[1] % self._lines(1)

    @cached_property
    def _numbers(self) -> np.ndarray:
        """Number of the node at every crossing of lines, (rows, columns), −1 where there is none."""
        x, y = self._element_lines
        numbers = np.full((self._lines(1), self._lines(0)), -1)
        numbers[y[:, :, None], x[:, None, :]] = 0
        there = numbers >= 0
        numbers[there] = np.arange(there.sum())
        return numbers

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return int(self._numbers.max()) + 1

    @cached_property
    def nodes(self) -> np.ndarray:
        """(E, N, N) the nodes of every element, by row and column of its points."""
        x, y = self._element_lines
        return self._numbers[y[:, :, None], x[:, None, :]]

    @property
    def node_cells(self) -> np.ndarray:
        """(c, 4) nodes at the corners of the cells between neighbouring nodes, counterclockwise."""
        nodes = self.nodes
        corners = [nodes[:, :-1, :-1], nodes[:, :-1, 1:], nodes[:, 1:, 1:], nodes[:, 1:, :-1]]
        return np.stack([corner.ravel() for corner in corners], axis=1)

    @cached_property
    def crossing(self) -> np.ndarray:
        """(n, 2) the lines across x and across y that every node lies on."""
        return np.argwhere(self._numbers >= 0)[:, ::-1]

    def _line_places(self, axis: int) -> np.ndarray:
        """Distance (lines,) of the lines across an axis from the origin, in elements."""
        cell, point = np.divmod(np.arange(self._lines(axis)), self.order)
        return cell + 0.5 * (1.0 + self.rule.points[point])

    @cached_property
    def positions(self) -> np.ndarray:
        """(n, 2) m."""
        return (
            np.stack([self._line_places(a)[self.crossing[:, a]] for a in (0, 1)], axis=1) * self.element + self.origin
        )

    @property
    def size(self) -> np.ndarray:
        """(2,) width and height with box and layers, m."""
        return np.array(self.cells) * self.element

    @property
    def inner(self) -> float:
        """The larger side (m) of what lies within all layers."""
        return float(max((self.cells[a] - sum(self.layer.along(a))) * self.element[a] for a in (0, 1)))

    def thickness(self, axis: int) -> tuple[float, float]:
        """Of the layers before and after along an axis, m."""
        before, after = self.layer.along(axis)
        return before * self.element[axis], after * self.element[axis]

    def line_depth(self, axis: int) -> np.ndarray:
        """Depth (lines,) of the lines across an axis in its layers, over their thickness: negative in the first one.

        Between −1 and 1, and 0 between the layers.
        """
        before, after = self.layer.along(axis)
        places, depth = self._line_places(axis), np.zeros(self._lines(axis))
        if before:
            depth -= np.clip(1.0 - places / before, 0.0, 1.0)
        if after:
            depth += np.clip(1.0 - (self.cells[axis] - places) / after, 0.0, 1.0)
        return depth

    @cached_property
    def depth(self) -> np.ndarray:
        """(n, 2) depth of every node in the layers along x and y, 0 … 1; 0 outside and where they begin."""
        return np.abs(np.stack([self.line_depth(a)[self.crossing[:, a]] for a in (0, 1)], axis=1))

    @cached_property
    def absorbs(self) -> np.ndarray:
        """(E, 2) bool, whether every element absorbs along x and along y."""
        each = []
        for axis in (0, 1):
            before, after = self.layer.along(axis)
            place = self.elements[:, axis]
            each.append((place < before) | (place >= self.cells[axis] - after))
        return np.stack(each, axis=1)

    @cached_property
    def held(self) -> np.ndarray:
        """(n,) bool, the nodes on the outer edges of layers."""
        return (self.depth == 1.0).any(axis=1)

    @cached_property
    def areas(self) -> np.ndarray:
        """(n,) m², of the quadrature: mass over density and thickness."""
        each = 0.25 * self.element[0] * self.element[1] * np.outer(self.rule.weights, self.rule.weights)
        return np.bincount(self.nodes.ravel(), np.tile(each.ravel(), len(self.nodes)), self.count)

    def located(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The element (k,) nearest to each of the points (k, 2) m, and their places (k, 2) in it, −1 … 1 inside."""
        cell = (np.asarray(points) - self.origin) / self.element  # in columns and rows
        away = np.abs(cell[:, None] - 0.5 - self.elements)
        beyond = np.maximum(away - 0.5, 0.0) * self.element
        chosen = np.argmin(np.sum(beyond**2, axis=2), axis=1)
        return chosen, 2.0 * (cell - self.elements[chosen]) - 1.0

    def interpolation(self, points: np.ndarray) -> Interpolation:
        """How displacements at points (k, 2) m follow from those of nodes.

        Those of a point within no element are extrapolated from the nearest one.
        """
        chosen, local = self.located(points)
        x, y = (self.rule.shape(local[:, a]) for a in (0, 1))
        count = len(local)
        return Interpolation(self.nodes[chosen].reshape(count, -1), (y[:, :, None] * x[:, None, :]).reshape(count, -1))

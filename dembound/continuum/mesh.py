"""A mesh of rectangular spectral elements round a rectangular box, with absorbing elements at its sides."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dembound.continuum.axis import NONE, Around, Axis, Rule, divided
from dembound.table import Box


@dataclass(frozen=True, eq=False, kw_only=True)
class Mesh:
    """Elements in columns and rows, without those inside a box.

    Nodes are the Gauss–Lobatto–Legendre points, N × N in an element, numbered row by row from the bottom, from left to
    right. The outer edges of absorbing layers are held at rest; all other edges are free. Kernels are fast if columns
    have few widths and rows few heights.

    Attributes
    ----------
    order : of the elements, N − 1.
    widths, heights : of the columns from left to right, and of the rows from the bottom, m.
    origin : lower left corner, m.
    box : first column, first row, column after the last and row after the last of the elements left out; None: none.
    levels : in the columns left and right of the box the first rows that are left out, with all above them; None: none.
    layer : how many of the columns and rows absorb at each side.
    periodic : whether the first column (row) follows the last one.
    mirror : 1 for each side whose edge is a plane of symmetry.
    slit : whether the nodes on the line down from the lower right corner of the box are doubled, so that elements right
    of it may move otherwise there. The copies, which elements right of it have, are the last nodes, from the bottom.
    """

    order: int
    widths: tuple[float, ...]
    heights: tuple[float, ...]
    origin: tuple[float, float] = (0.0, 0.0)
    box: tuple[int, int, int, int] | None = None
    levels: tuple[int, int] | None = None
    layer: Around = NONE
    periodic: tuple[bool, bool] = (False, False)
    mirror: Around = NONE
    slit: bool = False

    def __post_init__(self) -> None:
        for axis, sizes in enumerate((self.widths, self.heights)):
            if self.periodic[axis] and any(self.layer.along(axis)):
                raise ValueError(f"a mesh that is periodic along axis {axis} has no absorbing layers there")
            if any(a and b for a, b in zip(self.mirror.along(axis), self.layer.along(axis), strict=True)):
                raise ValueError(f"a plane of symmetry across axis {axis} has no absorbing layer")
            if sum(self.layer.along(axis)) > len(sizes):
                raise ValueError(f"layers have more elements along axis {axis} than the mesh, {len(sizes)}")
        if self.levels is not None and (self.box is None or self.box[3] < len(self.heights) or self.periodic[0]):
            raise ValueError("only beside a box that reaches the free surface may that be lower")
        if self.slit and (self.box is None or not 0 < self.box[2] < len(self.widths) or self.box[1] == 0):
            raise ValueError("a slit runs down from the corner of a box, between elements")

    @classmethod
    def uniform(cls, *, element: tuple[float, float], cells: tuple[int, int], **others: Any) -> "Mesh":
        """A mesh of equal elements.

        element : their width and height, m. cells : number of columns and of rows. others : attributes of a mesh.
        """
        return cls(widths=(element[0],) * cells[0], heights=(element[1],) * cells[1], **others)

    @classmethod
    def around(
        cls,
        box: Box,
        element: tuple[float, float],
        order: int = 4,
        *,
        margin: Around,
        layer: Around,
        rows: Sequence[float] | None = None,
        surface: float | None = None,
        below: Sequence[float] = (),
        above: Sequence[float] | None = None,
        base: float | None = None,
        wider: Sequence[float] = (),
        **others: Any,
    ) -> "Mesh":
        """The mesh round a box (left, bottom, right, top; m), which may reach the free surface: no margin, no layer.

        element : largest width and height, m. Columns and rows beside the box divide its sides, and all others have the
            same widths and heights but for the rows between the box and a free surface above it, which divide that
            distance.
        margin, layer : elements at each side of the box without and with absorption.
        rows : heights of the rows beside the box from the bottom, m; those below have that of the first one. None: of
            equal height.
        surface : height y of a free surface above the box, m; None: the box reaches it, or there is a margin or layer.
        below, above : heights of rows below the box, in place of as many of the margin, and up to the surface, from the
            bottom, m; above is None: of equal height. base : height of the rows below all of them, m; None: that of the
            lowest row beside the box.
        wider : widths of absorbing elements at left and right, outwards, over those beside the box; empty: equal.
        others : attributes of a mesh; levels : numbers of rows beside the box at left and right.

        Raises ValueError if the box is empty, or the surface is below its top or has a margin or layer below it.
        """
        columns = divided(box[2] - box[0], element[0])
        rows = divided(box[3] - box[1], element[1]) if rows is None else tuple(rows)
        if not (columns and rows):
            raise ValueError("the box is empty")
        left, right = (
            (1.0,) * margin.along(0)[side] + tuple(wider or (1.0,) * count) * (count > 0)
            for side, count in enumerate(layer.along(0))
        )
        base = rows[0] if base is None else base
        bottom = (base,) * (max(margin.bottom - len(below), min(margin.bottom, 1)) + layer.bottom) + tuple(below)
        top = (rows[-1],) * (margin.top + layer.top)
        if surface is not None:
            if top:
                raise ValueError("a free surface above the box leaves no place for a margin or a layer at the top")
            if surface < box[3]:
                raise ValueError(f"the free surface, y = {surface:g} m, is below the top of the box, {box[3]:g} m")
            top = divided(surface - box[3], element[1]) if above is None else tuple(above)
        if (levels := others.pop("levels", None)) is not None:
            levels = len(bottom) + levels[0], len(bottom) + levels[1]
        return cls(
            order=order,
            widths=tuple(columns[0] * times for times in left[::-1]) + columns + tuple(columns[0] * t for t in right),
            heights=bottom + rows + top,
            origin=(box[0] - sum(left) * columns[0], box[1] - (len(bottom) - len(below)) * base - sum(below)),
            box=(len(left), len(bottom), len(left) + len(columns), len(bottom) + len(rows)),
            levels=levels,
            layer=layer,
            **others,
        )

    @cached_property
    def rule(self) -> Rule:
        """The points of an element along each axis."""
        return Rule(self.order)

    @cached_property
    def axes(self) -> tuple[Axis, Axis]:
        """Columns and rows of the mesh."""
        x, y = (
            Axis(self.rule, np.array(sizes), self.layer.along(axis), self.periodic[axis])
            for axis, sizes in enumerate((self.widths, self.heights))
        )
        return x, y

    @property
    def cells(self) -> tuple[int, int]:
        """Number of columns and of rows."""
        return len(self.widths), len(self.heights)

    @cached_property
    def tops(self) -> np.ndarray:
        """The row after the last one of every column, the box included."""
        tops = np.full(self.cells[0], self.cells[1])
        if self.levels is not None and self.box is not None:
            tops[: self.box[0]], tops[self.box[2] :] = self.levels
        return tops

    @cached_property
    def element_at(self) -> np.ndarray:
        """Number of the element in every row and column, −1 in the box and above the free surface."""
        numbers = np.where(np.arange(self.cells[1])[:, None] < self.tops, 0, -1)
        if self.box is not None:
            left, bottom, right, top = self.box
            numbers[bottom:top, left:right] = -1
        there = numbers >= 0
        numbers[there] = np.arange(there.sum())
        return numbers

    @cached_property
    def elements(self) -> np.ndarray:
        """(E, 2) column and row of every element, row by row from the bottom."""
        return np.argwhere(self.element_at >= 0)[:, ::-1]

    @cached_property
    def element_sizes(self) -> np.ndarray:
        """(E, 2) width and height of every element, m."""
        return np.stack([self.axes[a].sizes[self.elements[:, a]] for a in (0, 1)], axis=1)

    @cached_property
    def _shapes(self) -> tuple[np.ndarray, np.ndarray]:
        """The different widths and heights of elements, (S, 2) m ascending, and the number (E,) of each element's."""
        shapes, each = np.unique(self.element_sizes, axis=0, return_inverse=True)
        return shapes, each.ravel()

    @property
    def shapes(self) -> np.ndarray:
        """(S, 2) the different widths and heights that elements have, m."""
        return self._shapes[0]

    @property
    def element_shape(self) -> np.ndarray:
        """(E,) which of the shapes every element has."""
        return self._shapes[1]

    @cached_property
    def _element_lines(self) -> tuple[np.ndarray, np.ndarray]:
        """The lines through the points of every element along x and along y, (E, N) each."""
        lines = [self.order * self.elements[:, axis, None] + np.arange(self.order + 1) for axis in (0, 1)]
        return lines[0] % self.axes[0].lines, lines[1] % self.axes[1].lines

    @cached_property
    def _numbers(self) -> np.ndarray:
        """Number of the node at every crossing of lines, (rows, columns), −1 where there is none."""
        x, y = self._element_lines
        numbers = np.full((self.axes[1].lines, self.axes[0].lines), -1)
        numbers[y[:, :, None], x[:, None, :]] = 0
        there = numbers >= 0
        numbers[there] = np.arange(there.sum())
        return numbers

    @cached_property
    def doubled(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes (k,) on the slit of elements left of it, from the bottom, and their copies (k,)."""
        below = np.zeros(0, dtype=np.int64)
        if self.slit:
            assert self.box is not None
            below = self._numbers[: self.order * self.box[1] + 1, self.order * self.box[2]]
        return below, int(self._numbers.max()) + 1 + np.arange(len(below))

    @property
    def is_right(self) -> np.ndarray:
        """(E,) bool, the elements right of the box, also below it."""
        return self.elements[:, 0] >= (self.cells[0] if self.box is None else self.box[2])

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return int(self._numbers.max()) + 1 + len(self.doubled[0])

    @cached_property
    def nodes(self) -> np.ndarray:
        """(E, N, N) the nodes of every element, by row and column of its points."""
        x, y = self._element_lines
        nodes = self._numbers[y[:, :, None], x[:, None, :]]
        if self.slit:
            assert self.box is not None
            own, copies = self.doubled
            beside = nodes[self.elements[:, 0] == self.box[2], :, 0]
            on_it = np.searchsorted(own, beside).clip(max=len(own) - 1)  # numbers grow upwards
            nodes[self.elements[:, 0] == self.box[2], :, 0] = np.where(own[on_it] == beside, copies[on_it], beside)
        return nodes

    @property
    def node_cells(self) -> np.ndarray:
        """(c, 4) nodes at the corners of the cells between neighbouring nodes, counterclockwise.

        Without cells across periodic sides, whose corners do not surround them.
        """
        nodes = self.nodes
        corners = [nodes[:, :-1, :-1], nodes[:, :-1, 1:], nodes[:, 1:, 1:], nodes[:, 1:, :-1]]
        cells = np.stack([corner.ravel() for corner in corners], axis=1)
        lines = self.crossing[cells]
        return cells[(lines[:, 2] > lines[:, 0]).all(axis=1)]

    @property
    def rectangles(self) -> np.ndarray:
        """(E, 4) left, bottom, right and top of every element, m."""
        low, high = (
            np.stack([self.axes[a].edges[self.elements[:, a] + end] for a in (0, 1)], axis=1) for end in (0, 1)
        )
        return np.hstack([low + self.origin, high + self.origin])

    @cached_property
    def crossing(self) -> np.ndarray:
        """(n, 2) the lines across x and across y that every node lies on."""
        crossing = np.argwhere(self._numbers >= 0)[:, ::-1]
        return np.concatenate([crossing, crossing[self.doubled[0]]])

    @cached_property
    def positions(self) -> np.ndarray:
        """(n, 2) m."""
        return np.stack([self.axes[a].places[self.crossing[:, a]] for a in (0, 1)], axis=1) + self.origin

    @property
    def size(self) -> np.ndarray:
        """(2,) width and height with box and layers, m."""
        return np.array([axis.length for axis in self.axes])

    @property
    def sides(self) -> tuple[float, float, float, float]:
        """Left, right, lower and upper side of the box, m; of the mesh if it has no box."""
        left, bottom, right, top = self.box or (0, 0, *self.cells)
        x, y = (self.origin[a] + axis.edges for a, axis in enumerate(self.axes))
        return float(x[left]), float(x[right]), float(y[bottom]), float(y[top])

    @property
    def inner(self) -> float:
        """The larger side (m) of what lies within all layers."""
        return max(axis.inner for axis in self.axes)

    @property
    def between_layers(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower left and upper right corner (2,) m of what lies between the layers, with the box."""
        before, after = np.transpose([axis.thickness for axis in self.axes])
        return self.origin + before, self.origin + self.size - after

    @cached_property
    def depth(self) -> np.ndarray:
        """(n, 2) depth of every node in the layers along x and y, 0 … 1; 0 outside and where they begin."""
        return np.abs(np.stack([self.axes[a].depth[self.crossing[:, a]] for a in (0, 1)], axis=1))

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

    def on_mirrors(self, axis: int) -> np.ndarray:
        """Nodes (k,) on planes of symmetry across an axis, ascending, without held ones."""
        line, ends = self.crossing[:, axis], (0, self.axes[axis].lines - 1)
        there = [line == end for end, plane in zip(ends, self.mirror.along(axis), strict=True) if plane]
        return np.flatnonzero(np.any(there, axis=0) & ~self.held) if there else np.zeros(0, dtype=np.int64)

    @property
    def quadrature(self) -> np.ndarray:
        """(E, N, N) m², weights of the points of every element; their sum is its area."""
        weights = np.outer(self.rule.weights, self.rule.weights)
        return 0.25 * np.prod(self.element_sizes, axis=1)[:, None, None] * weights

    @cached_property
    def areas(self) -> np.ndarray:
        """(n,) m², of the quadrature: mass over density and thickness."""
        return self.areas_of(slice(None))

    def areas_of(self, chosen: np.ndarray | slice) -> np.ndarray:
        """(n,) m², the part of the areas in some elements."""
        return np.bincount(self.nodes[chosen].ravel(), self.quadrature[chosen].ravel(), self.count)

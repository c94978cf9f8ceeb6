"""Elements of a mesh along one axis and at its sides, with the Gauss-Lobatto-Legendre points of elements."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

WHOLE = 1e-9
"""Part of an element by which a length may exceed a whole number of elements without another one."""


class Around(NamedTuple):
    """Numbers of elements at the four sides."""

    left: int = 0
    right: int = 0
    bottom: int = 0
    top: int = 0

    def along(self, axis: int) -> tuple[int, int]:
        """Layers before and after along x (axis 0) or y (1)."""
        return (self.left, self.right) if axis == 0 else (self.bottom, self.top)


NONE = Around()


class Rule:
    """The points on [−1, 1] of elements of an order p, N = p + 1 of them.

    They are ±1 and the roots of P′_p, and integrate polynomials up to degree 2p − 1 exactly (Canuto et al. 2006,
    Spectral Methods: Fundamentals in Single Domains, section 2.3).

    Parameters
    ----------
    order : p, at least 1.
    """

    def __init__(self, order: int) -> None:
        self.order = order
        self.count = order + 1

    @cached_property
    def points(self) -> np.ndarray:
        """(N,) ascending, mirror images of each other to the last bit."""
        inner = np.sort(legendre.legroots(legendre.legder(np.eye(self.order + 1)[-1])).real)
        points = np.concatenate([[-1.0], inner, [1.0]])
        return 0.5 * (points - points[::-1])

    @cached_property
    def _legendre(self) -> np.ndarray:
        """P_p at the points, (N,)."""
        return legendre.legval(self.points, np.eye(self.order + 1)[-1])

    @cached_property
    def weights(self) -> np.ndarray:
        """(N,) of the quadrature; their sum is 2."""
        return 2.0 / (self.order * (self.order + 1) * self._legendre**2)

    @cached_property
    def derivative(self) -> np.ndarray:
        """(N, N) D, so that D f are the derivatives at the points of the polynomial with values f there."""
        away = self.points[:, None] - self.points + np.eye(self.count)
        matrix = self._legendre[:, None] / (self._legendre * away)
        matrix[np.diag_indices(self.count)] = 0.0
        matrix[0, 0], matrix[-1, -1] = -0.25 * self.order * self.count, 0.25 * self.order * self.count
        return matrix

    def shape(self, x: np.ndarray) -> np.ndarray:
        """Values (k, N) at x (k,) of the polynomials that are 1 at one point and 0 at the others; also beyond ±1."""
        away = self.points[:, None] - self.points
        others = ~np.eye(self.count, dtype=np.bool_)
        each = [
            np.prod((np.asarray(x)[:, None] - self.points[others[j]]) / away[j, others[j]], axis=1)
            for j in range(self.count)
        ]
        return np.stack(each, axis=1)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Derivatives (k, N) at x (k,) of the polynomials of `shape`."""
        return self.shape(x) @ self.derivative


@dataclass(frozen=True, eq=False)
class Axis:
    """The columns or the rows of a mesh; places are distances (m) from the beginning of the first one.

    Attributes
    ----------
    rule : the points of a cell.
    sizes : (c,) of the cells along the axis, m.
    layer : how many of the first and of the last cells absorb.
    periodic : whether the first cell follows the last one.
    """

    rule: Rule
    sizes: np.ndarray
    layer: tuple[int, int] = (0, 0)
    periodic: bool = False

    @property
    def lines(self) -> int:
        """Number of lines of nodes."""
        return self.rule.order * len(self.sizes) + (not self.periodic)

    @cached_property
    def edges(self) -> np.ndarray:
        """(c + 1,) places of the edges of cells, m."""
        return np.append(0.0, np.cumsum(self.sizes))

    @property
    def length(self) -> float:
        """Length of all cells, m."""
        return float(self.edges[-1])

    @cached_property
    def places(self) -> np.ndarray:
        """(lines,) of the lines of nodes, m."""
        return self._places(self.sizes)[: self.lines]

    def _places(self, sizes: np.ndarray) -> np.ndarray:
        """Places of the lines in cells of these sizes, the last edge included."""
        edges = np.append(0.0, np.cumsum(sizes))
        inside = edges[:-1, None] + sizes[:, None] * 0.5 * (1.0 + self.rule.points[:-1])
        return np.append(inside.ravel(), edges[-1])

    @property
    def thickness(self) -> tuple[float, float]:
        """Thickness of the layers before and after, m."""
        before, after = self.layer
        return float(np.sum(self.sizes[:before])), float(np.sum(self.sizes[len(self.sizes) - after :]))

    @property
    def inner(self) -> float:
        """Length between the layers, m."""
        before, after = self.layer
        return float(np.sum(self.sizes[before : len(self.sizes) - after]))

    @cached_property
    def depth(self) -> np.ndarray:
        """Depth (lines,) of the lines in the layers, over their thickness: negative in the first one.

        −1 and 1 to the last bit at the outer edges, and 0 between the layers.
        """
        depth, order = np.zeros(self.lines), self.rule.order
        before, after = self.layer
        if before:
            places = self._places(self.sizes[before - 1 :: -1])  # from the inner edge outwards
            depth[: order * before + 1] -= (places / places[-1])[::-1]
        if after:
            places = self._places(self.sizes[-after:])
            depth[-order * after - 1 :] += places / places[-1]
        return depth

    def cell_at(self, places: np.ndarray) -> np.ndarray:
        """The cell (k,) at each of the places (k,) m: the one before on an edge, the end cell beyond the ends."""
        return np.searchsorted(self.edges[1:-1], places)


def divided(length: float, largest: float) -> tuple[float, ...]:
    """The sizes (m) of the fewest equal parts of a length that are not larger than `largest`."""
    count = math.ceil(length / largest - WHOLE)
    return (length / count,) * count if count else ()

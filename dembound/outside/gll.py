"""Gauss–Lobatto–Legendre points, used as the element's nodes and for quadrature."""

from functools import cached_property

import numpy as np
from numpy.polynomial import legendre


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

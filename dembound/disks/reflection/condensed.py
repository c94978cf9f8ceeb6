"""Networks of disks in steady oscillation, condensed to some of their degrees of freedom.

A motion u e^{iωt} at the steps of central differences needs the forces D u e^{iωt}, with the dynamic stiffness

    D = K − ((2/Δt) sin(ωΔt/2))² M + i (sin(ωΔt)/Δt) C,

exactly that of the scheme with centred dashpots C. If no forces act on all but some kept degrees of freedom k, those on
these are S u_k with S = D_kk − D_ki D_ii⁻¹ D_ik. With the kept ones last, S is the product of the last blocks of the
factors of D, L_kk U_kk, which takes one factorisation and no solve.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.disks.material.homogenise import Network

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

SYMMETRIC = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
"""Options of SuperLU for matrices with a symmetric pattern: pivots on the diagonal, which keeps their order."""


class Oscillation(NamedTuple):
    """A frequency at the steps of central differences.

    omega : ω, rad/s; time_step : s, 0 for continuous time.
    """

    omega: float
    time_step: float

    @property
    def square(self) -> float:
        """The factor that replaces ω² of continuous time, 1/s²."""
        if self.time_step == 0.0:
            return self.omega**2
        return (2.0 / self.time_step * math.sin(0.5 * self.omega * self.time_step)) ** 2

    @property
    def rate(self) -> complex:
        """The factor that replaces iω of continuous time at dashpots, 1/s."""
        if self.time_step == 0.0:
            return 1j * self.omega
        return 1j * math.sin(self.omega * self.time_step) / self.time_step

    @property
    def back(self) -> complex:
        """The factor e^{−iωΔt} of a motion one step earlier."""
        return cmath.exp(-1j * self.omega * self.time_step)

    @property
    def lagging(self) -> complex:
        """Velocity half a step behind over the displacement, 1/s."""
        return 1j * self.omega if self.time_step == 0.0 else (1.0 - self.back) / self.time_step


class Body(NamedTuple):
    """Disks, their degrees of freedom numbered as all x, all y, all rotations.

    within : contacts, and beyond : those across the sides that are periodic, by how many periods (b,) the second disk
    lies beyond; mass, damping, stiffness (3n,) of disks, of dashpots and of springs to what is fixed; moves (3n,) bool.
    """

    within: Network
    beyond: Network
    periods: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    moves: np.ndarray

    def numbers(self, disks: np.ndarray) -> np.ndarray:
        """Numbers of the moving degrees of freedom of some disks."""
        every = (np.arange(3)[:, None] * self.within.disks + disks).ravel()
        return every[self.moves[every]]


class Condensed:
    """The dynamic stiffness of a body on the disks at its interface, beside copies of itself along the interface.

    Parameters
    ----------
    body : the disks. interface : numbers (k,) of the degrees of freedom at the interface.

    Attributes
    ----------
    body, interface : as given.

    A contact across a periodic side goes to the image of a disk, whose motion is the disk's times a phase. First the
    body is condensed to the interface, the disks that have images, and these; then, for every wave along the interface,
    to the interface.
    """

    def __init__(self, body: Body, interface: np.ndarray) -> None:
        from scipy.sparse import diags

        self.body, self.interface = body, interface
        count, (disks, periods, beyond) = body.within.disks, _images(body)
        every = beyond.disks
        own = (every * np.arange(3)[:, None] + np.arange(count)).ravel()
        images = (every * np.arange(3)[:, None] + count + np.arange(len(disks))).ravel()
        imaged = (count * np.arange(3)[:, None] + disks).ravel()  # of the body, which the images are of
        moves = body.moves[imaged]
        images, imaged, periods = images[moves], imaged[moves], np.tile(periods, 3)[moves]
        base = np.concatenate([interface, np.setdiff1d(imaged, interface)])
        place = np.full(3 * count, -1)
        place[base] = np.arange(len(base))
        self._base, self._turned = len(base), []  # by periods ahead: images, and what they are of
        for ahead in np.unique(periods).tolist():
            chosen = np.flatnonzero(periods == ahead)
            self._turned.append((ahead, len(base) + chosen, place[imaged[chosen]]))

        matrix = (_stiffness(body.within._replace(disks=every)) + _stiffness(beyond)).tocsc()
        mass, damping, springs = np.zeros((3, 3 * every))
        mass[own], damping[own], springs[own] = body.mass, body.damping, body.stiffness
        others = own[np.setdiff1d(np.flatnonzero(body.moves), base)]
        matrix += diags(springs)
        order = np.concatenate([_in_order(matrix, others), own[base], images])
        self._inner, self._mass, self._damping = len(others), mass[order], damping[order]
        self._matrix = matrix[order][:, order].tocsc()
        self._fixed: np.ndarray | None = None

    def at(self, oscillation: Oscillation) -> None:
        """Condense at a frequency."""
        from scipy.sparse import diags

        added = -oscillation.square * self._mass
        if self._damping.any():
            added = added + oscillation.rate * self._damping
        self._fixed = _last_block(self._matrix + diags(added, format="csc"), self._inner)

    def stiffness(self, phase: complex) -> np.ndarray:
        """Dynamic stiffness (k, k) of the interface if the next copy moves as this one times the phase."""
        assert self._fixed is not None
        base, kept = self._base, len(self.interface)
        columns = self._fixed[:, :base].astype(complex)
        for periods, images, imaged in self._turned:
            columns[:, imaged] += phase**periods * self._fixed[:, images]
        matrix = columns[:base]
        for periods, images, imaged in self._turned:
            matrix[imaged] += np.conj(phase**periods) * columns[images]
        if base == kept:
            return matrix
        return matrix[:kept, :kept] - matrix[:kept, kept:] @ np.linalg.solve(matrix[kept:, kept:], matrix[kept:, :kept])


def _images(body: Body) -> tuple[np.ndarray, np.ndarray, Network]:
    """Disks (m,) that have images, how many periods ahead (m,) these are, and the contacts across sides with images.

    A contact with a disk behind is replaced by the contact of that disk with an image ahead.
    """
    beyond, ahead = body.beyond, body.periods > 0
    pairs, row = beyond.pairs.copy(), np.arange(len(body.periods))
    of = np.column_stack([pairs[row, ahead.astype(int)], np.abs(body.periods)])
    images, number = np.unique(of, axis=0, return_inverse=True)
    pairs[row, ahead.astype(int)] = body.within.disks + number.ravel()
    disks, periods = images.T
    return disks, periods, beyond._replace(disks=body.within.disks + len(disks), pairs=pairs)


def _stiffness(network: Network) -> csc_matrix:
    """The stiffness matrix (3n, 3n) of contacts, N/m."""
    ways = network.motion_matrix()
    return (ways.T @ ways.multiply(network.springs[:, None])).tocsc()


def _in_order(matrix: csc_matrix, chosen: np.ndarray) -> np.ndarray:
    """Some rows of a symmetric matrix, in an order in which its factors remain sparse."""
    from scipy.sparse import eye
    from scipy.sparse.linalg import splu

    if len(chosen) == 0:
        return chosen
    part = abs(matrix[chosen][:, chosen])
    dominant = (part + float(part.sum(axis=0).max()) * eye(len(chosen))).tocsc()
    return chosen[np.argsort(splu(dominant, permc_spec="MMD_AT_PLUS_A", **SYMMETRIC).perm_c)]


def _last_block(matrix: csc_matrix, first: int) -> np.ndarray:
    """The symmetric matrix condensed to its rows from `first` on."""
    from scipy.sparse.linalg import splu

    if first == 0:
        return matrix.toarray()
    try:
        factors = splu(matrix, permc_spec="NATURAL", **SYMMETRIC)
    except RuntimeError:  # a pivot on the diagonal is zero
        factors = None
    if factors is not None and np.array_equal(factors.perm_c, factors.perm_r):
        last = factors.perm_c[first:] - first
        if last.min() >= 0:
            product = factors.L[first:, first:].toarray() @ factors.U[first:, first:].toarray()
            return product[np.ix_(last, last)]
    inner = splu(
        matrix[:first, :first].tocsc(), permc_spec="MMD_AT_PLUS_A"
    )  # rows that are not connected change places
    return matrix[first:, first:].toarray() - matrix[first:, :first] @ inner.solve(matrix[:first, first:].toarray())

"""Waves in a row of equal bricks and their reflection at its end, by networks condensed to some degrees of freedom."""

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
    # rows that are not connected change places
    inner = splu(matrix[:first, :first].tocsc(), permc_spec="MMD_AT_PLUS_A")
    return matrix[first:, first:].toarray() - matrix[first:, :first] @ inner.solve(matrix[:first, first:].toarray())


RANK = 1e-11
"""Diagonal entries of the triangle of S₁₂, over the largest one, that count as rank."""

PROPAGATES = 1e-6
"""Difference of |λ| from 1 below which a wave propagates; of others a side reflects nothing that gets far."""

APART = 1.5 * np.exp(1.0j)
"""A λ different from that of any wave, except by chance."""

SMALLEST = 1e-12
"""1/|λ| below which λ is infinite: a motion of the first interface only."""


class Modes(NamedTuple):
    """The m waves of a row.

    factor : λ (m,). x, y : (r, m) x and ŷ. motion : (k, m) of the interface. power : (m,) carried inwards, 0
    unless they propagate. v : V (k, r).
    """

    factor: np.ndarray
    x: np.ndarray
    y: np.ndarray
    motion: np.ndarray
    power: np.ndarray
    v: np.ndarray

    @property
    def outgoing(self) -> np.ndarray:
        """Mask (m,) of the waves that carry power outwards, to the side."""
        return self.power < 0.0

    @property
    def returning(self) -> np.ndarray:
        """Mask (m,) of the waves that carry power inwards or die out inwards."""
        return (self.power > 0.0) | ((self.power == 0.0) & (np.abs(self.factor) > 1.0))


def modes_of(stiffness: np.ndarray) -> Modes:
    """The waves of bricks with the dynamic stiffness (2k, 2k) of both interfaces."""
    from scipy.linalg import qr

    k = len(stiffness) // 2
    u, triangle, order = qr(stiffness[:k, k:], pivoting=True)
    sizes = np.abs(np.diagonal(triangle))
    rank = int(np.count_nonzero(sizes > RANK * sizes[0]))
    root = np.sqrt(sizes[:rank])
    v = np.empty((k, rank), dtype=complex)
    v[order] = triangle[:rank].conj().T / root
    u = u[:, :rank] * root
    by_u, by_v = np.split(np.linalg.solve(stiffness[:k, :k] + stiffness[k:, k:], np.hstack([u, v])), 2, axis=1)
    one, none = np.eye(rank), np.zeros((rank, rank))
    left = np.block([[one, v.conj().T @ by_v], [none, u.conj().T @ by_v]])
    right = np.block([[v.conj().T @ by_u, none], [u.conj().T @ by_u, one]])
    inverse, shapes = np.linalg.eig(np.linalg.solve(left + APART * right, right))  # 1/(APART − λ)
    finite = np.abs(inverse) > SMALLEST
    factor, (x, y) = APART - 1.0 / inverse[finite], np.split(shapes[:, finite], 2)
    motion = -(by_u @ (x * factor) + by_v @ y)
    power = np.where(np.abs(np.abs(factor) - 1.0) < PROPAGATES, np.imag(np.sum(x.conj() * y, axis=0)), 0.0)
    return Modes(factor, x, y, motion, power, v)


def modes_of_copies(stiffness: np.ndarray, shifts: np.ndarray) -> Modes:
    """Modes of bricks of several copies side by side, from the waves of each growth of phase from copy to copy.

    shifts : (c, k, k/c) orthonormal motions of an interface for each growth of phase, which contacts do not couple.
    """
    k = len(stiffness) // 2
    across = shifts.conj().swapaxes(1, 2)
    blocks = [[across @ stiffness[a : a + k, b : b + k] @ shifts for b in (0, k)] for a in (0, k)]
    left_side, sizes, right_side = np.linalg.svd(blocks[0][1])
    rank = int(np.count_nonzero(sizes > RANK * sizes.max(), axis=1).max(initial=1))
    root = np.sqrt(sizes[:, None, :rank])
    u, v = left_side[:, :, :rank] * root, right_side.conj().swapaxes(1, 2)[:, :, :rank] * root
    by_u, by_v = np.split(np.linalg.solve(blocks[0][0] + blocks[1][1], np.concatenate([u, v], axis=2)), 2, axis=2)
    one, none = np.broadcast_to(np.eye(rank), (len(u), rank, rank)), np.zeros((len(u), rank, rank))
    to_u, to_v = u.conj().swapaxes(1, 2), v.conj().swapaxes(1, 2)
    left = np.block([[one, to_v @ by_v], [none, to_u @ by_v]])
    right = np.block([[to_v @ by_u, none], [to_u @ by_u, one]])
    inverse, shapes = np.linalg.eig(np.linalg.solve(left + APART * right, right))
    finite = np.abs(inverse) > SMALLEST
    factor = APART - 1.0 / np.where(finite, inverse, 1.0)
    x, y = np.split(shapes, 2, axis=1)
    motion = shifts @ -(by_u @ (x * factor[:, None]) + by_v @ y)
    power = np.where(np.abs(np.abs(factor) - 1.0) < PROPAGATES, np.imag(np.sum(x.conj() * y, axis=1)), 0.0)
    apart = [_beside(each)[:, finite.ravel()] for each in (x, y)]
    found = finite.ravel()
    every = np.concatenate([*motion], axis=1)[:, found], power.ravel()[found], np.concatenate([*(shifts @ v)], axis=1)
    return Modes(factor.ravel()[found], apart[0], apart[1], *every)


def _beside(each: np.ndarray) -> np.ndarray:
    """Block-diagonal matrix (c m, c n) of matrices (c, m, n)."""
    count, rows, columns = each.shape
    found = np.zeros((count, rows, count, columns), dtype=each.dtype)
    found[np.arange(count), :, np.arange(count)] = each
    return found.reshape(count * rows, count * columns)


def sent_back(modes: Modes, incident: int, stiffness: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Power (m,) reflected by an end in each of the waves, over that of the incident one.

    stiffness : (2k, 2k) as for `modes_of`; end : S_e (k, k).
    """
    k = len(end)
    answer = -modes.v.conj().T @ np.linalg.solve(stiffness[k:, k:] + end, modes.v)
    back = np.flatnonzero(modes.returning)
    own = answer @ modes.y[:, incident] - modes.x[:, incident]
    amplitude = np.linalg.lstsq(modes.x[:, back] - answer @ modes.y[:, back], own, rcond=None)[0]
    power = np.zeros(len(modes.factor))
    power[back] = modes.power[back] * np.abs(amplitude) ** 2 / -modes.power[incident]
    return power

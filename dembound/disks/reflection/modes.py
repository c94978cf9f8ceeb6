"""Waves in a row of equal bricks, and their reflection at its end.

S₁₂ = U Vᴴ has a low rank r: motions that die out within a brick do not reach its next interface. In the coordinates
x = Vᴴp and y = Uᴴp of the interface, the waves p_c = λᶜp of the row are, with ŷ = y/λ and A = S₁₁ + S₂₂, those of

    [1  VᴴA⁻¹V; 0  UᴴA⁻¹V] [x; ŷ] = −λ [VᴴA⁻¹U  0; UᴴA⁻¹U  1] [x; ŷ],

2r of them, of which those with |λ| = 1 propagate. They carry the power ½ω Im(x̄·ŷ) inwards, without interference.
The end answers with x₀ = R y_{−1}, R = −Vᴴ(S₂₂ + S_e)⁻¹V, which the incident wave and those that run or die out
inwards fulfil together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

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

"""Blocks of unknowns in a row, each joined to its neighbours only, at many frequencies at once.

A link joins two blocks: with their velocities v₁ and v₂ it needs the forces F₁ = A v₁ + B v₂ and F₂ = C v₁ + D v₂. All
blocks between two can be eliminated, which leaves one link; a row of N equal blocks takes log₂N eliminations.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Link(NamedTuple):
    """The matrices A, B, C and D (f, b, b) of a link, at f frequencies, of blocks of b unknowns."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray


def joined(first: Link, middle: np.ndarray, second: Link) -> Link:
    """Two links as one, with the block between them, of the matrix middle (f, b, b), eliminated."""
    answer = solve(middle + first.d + second.a, np.concatenate([first.c, second.b], axis=2))
    by_left, by_right = np.split(answer, 2, axis=2)
    return Link(
        first.a - first.b @ by_left,
        -first.b @ by_right,
        -second.c @ by_left,
        second.d - second.c @ by_right,
    )


class Row:
    """Equal blocks in a row, middle (f, b, b) the matrix of each, equal links between them."""

    def __init__(self, link: Link, middle: np.ndarray) -> None:
        self.middle = middle
        self._powers = [link]  # of 1, 2, 4 ... links

    def links(self, count: int) -> Link:
        """`count` ≥ 1 links as one, with the blocks between them eliminated."""
        found: Link | None = None
        for bit in range(count.bit_length()):
            if bit == len(self._powers):
                self._powers.append(joined(self._powers[-1], self.middle, self._powers[-1]))
            if count >> bit & 1:
                found = self._powers[bit] if found is None else joined(found, self.middle, self._powers[bit])
        assert found is not None
        return found


def velocities(own: Sequence[np.ndarray], links: Sequence[Link], force: np.ndarray) -> np.ndarray:
    """Velocities (f, k, b) of the k blocks of a row under forces (f, k, b).

    own : the matrices (f, b, b) of the blocks without links; links : between each block and the next.
    """
    whole = [np.array(matrix) for matrix in own]
    for k, link in enumerate(links):
        whole[k] += link.a
        whole[k + 1] += link.d
    rest, answers = force.copy(), []
    for k, link in enumerate(links):  # eliminate from the left
        answers.append(solve(whole[k], np.concatenate([link.b, rest[:, k, :, None]], axis=2)))
        passed = link.c @ answers[k]
        whole[k + 1] -= passed[:, :, :-1]
        rest[:, k + 1] -= passed[:, :, -1]
    moved = np.empty_like(rest)
    moved[:, -1] = solve(whole[-1], rest[:, -1, :, None])[:, :, 0]
    for k in range(len(links) - 1, -1, -1):
        moved[:, k] = answers[k][:, :, -1] - (answers[k][:, :, :-1] @ moved[:, k + 1, :, None])[:, :, 0]
    return moved


def solve(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions (f, b, c) of f systems; matrix (f, b, b), right (f, b, c)."""
    return right / matrix if matrix.shape[-1] == 1 else np.linalg.solve(matrix, right)

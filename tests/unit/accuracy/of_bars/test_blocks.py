"""Rows of blocks, some of them eliminated, beside the whole system of equations."""

import numpy as np
import pytest

from dembound.accuracy.of_bars.blocks import Link, Row, joined, solve, velocities

RANDOM = np.random.default_rng(1)


def matrices(*shape: int) -> np.ndarray:
    return RANDOM.normal(size=shape) + 1j * RANDOM.normal(size=shape)


def row(blocks: int, wide: int) -> tuple[list[np.ndarray], list[Link]]:
    """Blocks that their own matrices dominate, with links, at two frequencies."""
    own = [matrices(2, wide, wide) + 12.0 * wide * np.eye(wide) for _ in range(blocks)]
    return own, [Link(*(matrices(2, wide, wide) for _ in range(4))) for _ in range(blocks - 1)]


def whole(own: list[np.ndarray], links: list[Link]) -> np.ndarray:
    """The matrix of all blocks together (2, kb, kb)."""
    wide = own[0].shape[-1]
    system = np.zeros((2, len(own) * wide, len(own) * wide), dtype=complex)
    for k, matrix in enumerate(own):
        here = slice(k * wide, (k + 1) * wide)
        system[:, here, here] += matrix
        if k < len(links):
            there = slice((k + 1) * wide, (k + 2) * wide)
            system[:, here, here] += links[k].a
            system[:, here, there] += links[k].b
            system[:, there, here] += links[k].c
            system[:, there, there] += links[k].d
    return system


@pytest.mark.parametrize("wide", [1, 3])
def test_velocities_solve_the_whole_system(wide: int) -> None:
    own, links = row(5, wide)
    force = matrices(2, 5, wide)

    found = velocities(own, links, force)

    expected = solve(whole(own, links), force.reshape(2, -1, 1)).reshape(force.shape)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("wide", [1, 2])
def test_a_block_without_a_force_may_be_eliminated(wide: int) -> None:
    own, links = row(3, wide)
    force = matrices(2, 3, wide)
    force[:, 1] = 0.0

    found = velocities([own[0], own[2]], [joined(links[0], own[1], links[1])], force[:, [0, 2]])

    np.testing.assert_allclose(found, velocities(own, links, force)[:, [0, 2]], rtol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 3, 6, 13])
def test_a_uniform_row_is_one_link(count: int) -> None:
    (first, middle, last), (link, _) = row(3, 2)
    own, force = [first, *(count - 1) * [middle], last], np.zeros((2, count + 1, 2), dtype=complex)
    force[:, [0, -1]] = matrices(2, 2, 2)

    found = velocities([first, last], [Row(link, middle).links(count)], force[:, [0, -1]])

    np.testing.assert_allclose(found, velocities(own, count * [link], force)[:, [0, -1]], rtol=1e-10)

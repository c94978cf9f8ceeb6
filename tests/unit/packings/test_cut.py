"""Contacts that end at the sides of a body."""

from collections import Counter

import numpy as np
import pytest

from dembound.packings.brick import Brick
from dembound.packings.cut import CutContacts, cut_contacts
from dembound.packings.tiling import Assembly, tile

OPEN = (False, False)


@pytest.fixture(params=["random", "edged"])
def brick(request) -> Brick:
    return request.getfixturevalue(f"{request.param}_brick")


def places(assembly: Assembly) -> list[tuple[int, int, int]]:
    """Tile x, tile y and disk of the brick of every disk."""
    return list(zip(*assembly.tile.T.tolist(), assembly.brick_particle.tolist(), strict=True))


def beyond(place: tuple[int, int, int], brick: Brick, copies: tuple[int, int]) -> set[str]:
    """The sides that a disk of the infinite tiling lies beyond; the regular rows close the frame at right and top."""
    sides = set()
    for axis, (low, high) in enumerate((("left", "right"), ("bottom", "top"))):
        if place[axis] < 0:
            sides.add(low)
        if place[axis] > copies[axis] - (0 if brick.edge_rows[place[2], axis] else 1):
            sides.add(high)
    return sides


def listed(cut: CutContacts, body: Assembly) -> Counter:
    """Place of the disk, place of the one beyond, contact, and which of its disks is in the body."""
    where = places(body)
    return Counter(
        (where[node], (int(x), int(y), int(other)), int(contact), int(second))
        for node, (x, y), other, contact, second in zip(
            cut.node, cut.tile, cut.other, cut.contact_type, cut.is_second, strict=True
        )
    )


def test_of_some_sides_those_contacts_are_cut_that_cross_no_other(brick) -> None:
    """Of all sides they are those under whose forces a body rests: `test_side_forces` and `test_wall`."""
    copies, sides = (3, 2), ("left", "right", "bottom")
    body = tile(brick, copies, OPEN)
    every = cut_contacts(brick, body, (*sides, "top"))
    ends = zip(*every.tile.T.tolist(), every.other.tolist(), strict=True)
    chosen = np.array([beyond(end, brick, copies) <= set(sides) for end in ends])

    assert 0 < np.count_nonzero(chosen) < len(chosen)
    assert listed(cut_contacts(brick, body, sides), body) == listed(every.only(chosen), body)


def test_periodic_sides_cut_nothing(brick) -> None:
    """A body that goes on sideways has the contacts of the middle bricks of a wider one."""
    periodic = tile(brick, (2, 2), (True, False))
    wide = tile(brick, (6, 2), OPEN)
    found = cut_contacts(brick, periodic, ("bottom",), (True, False))
    cut = cut_contacts(brick, wide, ("bottom",))
    middle = cut.only((wide.tile[cut.node, 0] >= 2) & (wide.tile[cut.node, 0] < 4))

    assert len(found.node) == len(middle.node) > 0
    for name in ("contact_type", "is_second", "other", "image", "side"):
        assert np.array_equal(np.sort(getattr(found, name), axis=0), np.sort(getattr(middle, name), axis=0)), name
    assert (found.tile[:, 0] >= 0).all()
    assert (found.tile[:, 0] < 2).all()


def test_the_mass_of_a_brick_has_a_centre() -> None:
    positions = np.array([[0.25, 0.5], [1.0, 0.25]])
    nothing = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 2), dtype=np.int64), np.zeros((2, 2), bool), np.zeros(3)
    brick = Brick(np.array([2.0, 1.0]), positions, np.array([0.1, 0.2]), *nothing, residual_ratio=0.0)
    np.testing.assert_allclose(brick.mass_offset, [0.85 - 1.0, 0.3 - 0.5])
    assert brick.row_widths.tolist() == [0.0, 0.0]
    nothing[2][0, 1] = True  # a fifth of the mass is in the row on y = 0
    np.testing.assert_allclose(brick.row_widths, [0.0, 0.2])


def test_disks_above_lower_ground_beyond_a_side_are_not_there(random_brick) -> None:
    body = tile(random_brick, (2, 3), OPEN)
    sides, height = ("left", "right", "bottom"), 0.4 * float(body.size[1])
    all_of_them, cut = (cut_contacts(random_brick, body, sides, tops=tops) for tops in ({}, {"right": height}))
    up = (body.positions[all_of_them.node] + all_of_them.vectors(random_brick))[:, 1]
    there = (all_of_them.side != 1) | (up < height)

    assert 0 < np.count_nonzero(~there) < np.count_nonzero(all_of_them.side == 1)
    assert listed(cut, body) == listed(all_of_them.only(there), body)

    middle = np.abs(body.positions - 0.5 * body.size).max(axis=1) < 0.3 * body.size.min()
    left, kept = body.without(middle)  # a hole cuts no contacts of the sides
    assert len(kept) < len(middle)
    assert listed(cut_contacts(random_brick, left, sides), left) == listed(all_of_them, body)

"""The free-field column: what it stands for, and what joins it to the body."""

from collections import Counter

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.packings import Square
from dembound.packings.brick import Brick
from dembound.packings.column import Seam, nearest_in_column, with_column
from dembound.packings.tiling import Assembly, tile

OPEN = (False, False)
BOTH = ("left", "right")
MARGIN = 2
"""Bricks beside the body in the wider one, which the cut at its own sides does not reach."""


def made_by_hand(size: tuple[float, float], radii: list[float], contacts: list[tuple[int, int, int, int]]) -> Brick:
    """A brick of disks at its corner with contacts (i, j, image x, image y); where its disks are is of no account."""
    columns = np.array(contacts)
    return Brick(
        size=np.array(size),
        positions=np.zeros((len(radii), 2)),
        radii=np.array(radii),
        pairs=columns[:, :2],
        images=columns[:, 2:],
        edge_rows=np.zeros((len(radii), 2), dtype=bool),
        stress=np.zeros(3),
        residual_ratio=0.0,
    )


@pytest.fixture
def dangling_brick() -> Brick:
    """Two disks that hold each other and their images, and a third that holds on to the next brick alone."""
    return made_by_hand((2.0, 1.0), [0.5, 0.5, 0.1], [(0, 1, 0, 0), (1, 0, 1, 0), (0, 0, 0, 1), (2, 0, 1, 0)])


@pytest.fixture(params=["square", "random", "edged", "dangling"])
def brick(request) -> Brick:
    if request.param == "square":
        return Square(size=(1.0, 1.0), radius=0.5).pack(1e9)
    return request.getfixturevalue(f"{request.param}_brick")


def places(assembly: Assembly, brick: Brick) -> list[tuple[int, int, int]]:
    """Tile x, tile y and disk of the brick of every disk."""
    disk = assembly.brick_particle
    tiles = np.rint((assembly.positions - brick.positions[disk]) / brick.size).astype(int)
    return [(int(x), int(y), int(p)) for (x, y), p in zip(tiles, disk, strict=True)]


def cut_contacts(brick: Brick, copies: tuple[int, int], sides: tuple[str, ...]) -> Counter:
    """Contacts of a wider body between a disk of the body and one beyond its sides, as seen from the former.

    Of each: the disk's place, the neighbour's tile y and disk, the brick's contact, whether the disk is its second,
    and the tiles from one to the other.
    """
    body = set(places(tile(brick, copies, OPEN), brick))
    wide = tile(brick, (copies[0] + 2 * MARGIN, copies[1]), OPEN)
    where = [(x - MARGIN, y, disk) for x, y, disk in places(wide, brick)]
    found: Counter = Counter()
    for pair, contact_type in zip(wide.pairs, wide.contact_type, strict=True):
        for second, (here, there) in enumerate((pair, pair[::-1])):
            node, (x, y, disk) = where[here], where[there]
            beyond = (x < 0 and "left" in sides) or (x >= copies[0] and "right" in sides)
            if node in body and (x, y, disk) not in body and beyond:
                found[node, (y, disk), int(contact_type), second, x - node[0]] += 1
    return found


def listed_contacts(brick: Brick, joint: Assembly, seam: Seam, body: Assembly) -> Counter:
    """The same from the seam."""
    column = places(tile(brick, (1, body.copies[1]), (True, False)), brick)
    where = places(body, brick)
    node = np.repeat(seam.node, seam.contact_counts) - seam.count
    return Counter(
        (where[n], column[near][1:], int(contact_type), int(second), int(image))
        for n, near, contact_type, second, image in zip(
            node, seam.neighbour, seam.contact_type, seam.twin_is_second, seam.image, strict=True
        )
    )


@pytest.mark.parametrize("sides", [BOTH, ("left",), ("right",)])
@pytest.mark.parametrize("copies", [(1, 1), (1, 3), (3, 2)])
def test_every_contact_that_a_side_cuts_is_in_the_seam_once(brick, copies, sides):
    body = tile(brick, copies, OPEN)
    joint, seam = with_column(brick, body, sides)
    expected = cut_contacts(brick, copies, sides)

    assert set(expected.values()) == {1}
    assert listed_contacts(brick, joint, seam, body) == expected


def test_seam_contacts_reach_from_the_twin_to_the_neighbour(dense_brick):
    joint, seam = with_column(dense_brick, tile(dense_brick, (2, 2), OPEN), BOTH)
    twin = np.repeat(seam.twin[seam.node], seam.contact_counts)
    reach = joint.positions[seam.neighbour] + np.outer(seam.image, [seam.width, 0.0]) - joint.positions[twin]
    vectors = dense_brick.vectors[seam.contact_type] * np.where(seam.twin_is_second, -1.0, 1.0)[:, None]

    assert np.abs(reach - vectors).max() < 1e-13  # round-off of 20 m
    assert np.all(np.diff(seam.node) > 0)
    assert np.all(seam.contact_counts > 0)
    assert (seam.start[0], seam.start[-1]) == (0, len(seam.neighbour))


def test_a_twin_stands_at_the_same_place_of_the_brick(brick):
    body = tile(brick, (3, 2), OPEN)
    joint, seam = with_column(brick, body, BOTH)
    own, others = seam.twin[: seam.count], seam.twin[seam.count :]

    assert own.tolist() == list(range(seam.count))
    assert others.max() < seam.count
    assert np.array_equal(joint.brick_particle[others], body.brick_particle)
    np.testing.assert_allclose(joint.positions[others, 1], body.positions[:, 1], atol=1e-13)


def test_column_and_body_stand_side_by_side_in_one_assembly(dense_brick):
    body = tile(dense_brick, (2, 3), OPEN)
    column = tile(dense_brick, (1, 3), (True, False))
    joint, seam = with_column(dense_brick, body, BOTH)

    assert seam.count == len(column.radii)
    assert seam.width == dense_brick.size[0]
    assert np.array_equal(joint.positions[seam.count :], body.positions)
    for name in ("radii", "brick_particle", "contact_type"):
        assert np.array_equal(getattr(joint, name), np.concatenate([getattr(column, name), getattr(body, name)]))
    assert np.array_equal(joint.pairs, np.concatenate([column.pairs, body.pairs + seam.count]))
    assert joint.pairs.dtype == body.pairs.dtype
    # the scene is the body's; the column is out of its way
    assert np.array_equal(joint.size, body.size)
    assert (joint.positions[: seam.count, 0] + joint.radii[: seam.count]).max() < (
        body.positions[:, 0] - body.radii
    ).min()


def test_disks_that_a_side_cuts_loose_stand_in_the_column(dangling_brick):
    body = tile(dangling_brick, (2, 1), OPEN)
    joint, seam = with_column(dangling_brick, body, BOTH)

    assert body.loose == joint.loose == 1
    assert seam.count == 3


def test_a_body_of_other_disks_than_the_column_is_refused():
    # a row of the first disk is the larger part of a wide body, a stack of the second that of a column
    brick = made_by_hand((1.0, 1.0), [0.3, 0.2], [(0, 0, 1, 0), (1, 1, 0, 1)])
    with pytest.raises(PackingError, match="4 disks of the body have no twin in the free-field column"):
        with_column(brick, tile(brick, (4, 2), OPEN), BOTH)


def test_a_column_of_more_rows_than_the_body_has_its_twins_at_the_same_height(dense_brick):
    body = tile(dense_brick, (2, 3), OPEN, (30.0, 2 * dense_brick.size[1]))
    joint, seam = with_column(dense_brick, body, BOTH, rows=(2, 7), left=-5.0)
    count = seam.count
    assert count == joint.column.disks == len(tile(dense_brick, (1, 7), (True, False)).radii)
    assert joint.column.copies == (1, 7)
    body_y, twin_y = joint.positions[count:, 1], joint.positions[seam.twin[count:], 1]
    np.testing.assert_allclose(twin_y, body_y, rtol=0.0, atol=1e-12)
    assert np.array_equal(joint.brick_particle[seam.twin], joint.brick_particle)
    assert joint.positions[:count, 0].max() < -5.0  # to the left of all that is there
    part = joint.part(slice(0, count))
    assert part.size.tolist() == (dense_brick.size * (1, 7)).tolist()
    assert part.origin[1] == 0.0
    assert np.array_equal(joint.part(slice(count, len(joint.radii))).origin, body.origin)


@pytest.mark.parametrize("rows", [(2, 7), (0, 5), (2, 5)], ids=["in the middle", "at the foot", "at the top"])
def test_beyond_all_four_sides_are_the_column_s_own_disks(brick, rows):
    """Every cut contact is one of the column; where the column ends there is none beyond."""
    body = tile(brick, (3, 3), OPEN, (0.0, rows[0] * float(brick.size[1])))
    joint, seam = with_column(brick, body, ("left", "right", "bottom", "top"), rows)
    owner, other, vectors = seam.pairs(brick)
    column = tile(brick, (1, rows[1]), (True, False))
    up = column.tile[other, 1] - column.tile[owner, 1]
    node = np.repeat(seam.node, seam.contact_counts)
    place = joint.tile[node] + np.stack([seam.image, up], axis=1)
    beyond = (place < 0) | (place > 2 + brick.edge_rows[joint.brick_particle[other]])  # those close the frame
    assert beyond.any(axis=1).all()
    assert (place[:, 1] < 0).any() == (rows[0] > 0)
    assert (beyond[:, 1] & (place[:, 1] > 0)).any() == (rows[0] + 3 < rows[1])
    assert np.array_equal(joint.brick_particle[owner], joint.brick_particle[node])
    if brick.positions.any():  # not of those made by hand
        ways = column.positions[other] - column.positions[owner] + seam.image[:, None] * [seam.width, 0.0]
        np.testing.assert_allclose(ways, vectors, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("rows", [(-1, 7), (5, 7)])
def test_a_body_that_is_not_within_the_column_is_refused(dense_brick, rows):
    with pytest.raises(PackingError, match="have no twin in the free-field column"):
        with_column(dense_brick, tile(dense_brick, (2, 3), OPEN), BOTH, rows)


@pytest.mark.parametrize("size", [1.0, 0.1, 1.0 / 3.0])
def test_places_between_rows_have_the_lower_disk_of_the_column(size):
    """However far away they are, where their coordinates are rounded otherwise."""
    brick = Square(pattern="A", size=(2 * size, 9 * size), radius=0.5 * size).pack(1.0)
    joint, _ = with_column(brick, tile(brick, (2, 9), (False, False)), ("left", "right"))
    rows = np.arange(1, 9)
    for away in (0.0, 77.5, -1e4):
        found = nearest_in_column(joint, size * np.column_stack([np.full(8, away), rows]))
        np.testing.assert_allclose(joint.positions[found, 1], size * (rows - 0.5), rtol=1e-12)

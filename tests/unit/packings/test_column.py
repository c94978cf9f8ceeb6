"""The free-field column: the ground that it represents, and its contacts with the body."""

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.packings import Square
from dembound.packings.brick import Brick
from dembound.packings.column import nearest_in_column, with_column
from dembound.packings.tiling import tile

OPEN = (False, False)
BOTH = ("left", "right")


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


@pytest.fixture(params=["edged", "dangling"])
def brick(request) -> Brick:
    return request.getfixturevalue(f"{request.param}_brick")


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


def test_disks_that_a_side_cuts_loose_stand_in_the_column_and_others_are_refused(dangling_brick, random_brick):
    body = tile(dangling_brick, (2, 1), OPEN)
    joint, seam = with_column(dangling_brick, body, BOTH)
    assert body.loose == joint.loose == 1
    assert seam.count == 3
    # a row of the first disk is the larger part of a wide body, a stack of the second that of a column
    brick = made_by_hand((1.0, 1.0), [0.3, 0.2], [(0, 0, 1, 0), (1, 1, 0, 1)])
    with pytest.raises(PackingError, match="4 disks of the body have no twin in the free-field column"):
        with_column(brick, tile(brick, (4, 2), OPEN), BOTH)
    for rows in ((-1, 7), (5, 7)):
        with pytest.raises(PackingError, match="have no twin in the free-field column"):
            with_column(random_brick, tile(random_brick, (2, 3), OPEN), BOTH, rows)


def test_a_column_of_more_rows_than_the_body_has_its_twins_at_the_same_height(dense_brick):
    body = tile(dense_brick, (2, 3), OPEN, (30.0, 2 * dense_brick.size[1]))
    joint, seam = with_column(dense_brick, body, BOTH, rows=(2, 7), beside=(-5.0, 0.0))
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


@pytest.mark.parametrize("rows", [(2, 7), (0, 5)], ids=["in the middle", "at the foot"])
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


@pytest.mark.parametrize("size", [0.1, 1.0 / 3.0])
def test_places_between_rows_have_the_lower_disk_of_the_column(size):
    """However far away they are, where their coordinates are rounded otherwise."""
    brick = Square(pattern="A", size=(2 * size, 9 * size), radius=0.5 * size).pack(1.0)
    joint, _ = with_column(brick, tile(brick, (2, 9), (False, False)), ("left", "right"))
    rows = np.arange(1, 9)
    for away in (0.0, 77.5, -1e4):
        found = nearest_in_column(joint, size * np.column_stack([np.full(8, away), rows]))
        np.testing.assert_allclose(joint.positions[found, 1], size * (rows - 0.5), rtol=1e-12)

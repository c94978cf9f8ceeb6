"""Assemblies: counts, numbering, geometry and the frame."""

from collections import Counter

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.packings import Square
from dembound.packings.brick import Brick
from dembound.packings.column import Standing, nearest_in_column, with_columns
from dembound.packings.cut import CutContacts, cut_contacts
from dembound.packings.tiling import Assembly, tile


@pytest.fixture
def square():
    return Square(size=(1.0, 1.0), radius=0.5).pack(1e9)


@pytest.mark.parametrize("periodic", [(False, False), (True, False)])
def test_an_open_edge_loses_exactly_the_contacts_across_it(random_brick, square, periodic):
    body = tile(random_brick, (3, 2), periodic)
    ix, iy = np.where(periodic, 0, np.abs(random_brick.images)).T
    assert np.array_equal(np.bincount(body.contact_type), (3 - ix) * (2 - iy))
    keys = body.pairs[:, 0].astype(np.int64) * len(random_brick.pairs) + body.contact_type
    assert np.all(np.diff(keys) > 0)
    line = tile(square, (3, 1), (False, True))  # one periodic copy keeps its contacts with itself
    itself = line.pairs[:, 0] == line.pairs[:, 1]
    assert line.contact_type[itself].tolist() == [1, 1, 1]


@pytest.mark.parametrize("copies", [(5, 2), (2, 5)])
def test_numbering_runs_along_the_length(square, copies):
    positions = tile(square, copies, (False, False)).positions
    length = 0 if copies[0] > copies[1] else 1
    assert np.all(np.diff(positions[:, length]) >= 0)
    assert positions[:2].max() == 1.5  # the first two lie across the bar
    assert positions[0].tolist() == [0.5, 0.5]


@pytest.mark.parametrize("periodic", [(True, False), (False, True)])
def test_every_contact_has_the_vector_of_its_kind(dense_brick, periodic):
    body = tile(dense_brick, (3, 2), periodic)
    first, second = body.pairs.T
    apart = body.positions[second] - body.positions[first]
    wraps = np.where(periodic, body.size, np.inf)
    miss = apart - dense_brick.vectors[body.contact_type]
    miss -= np.where(periodic, np.rint(miss / wraps) * body.size, 0.0)
    assert np.abs(miss).max() < 1e-13  # round-off of 30 m
    assert np.array_equal(body.brick_particle[body.pairs], dense_brick.pairs[body.contact_type])


def test_open_contacts_are_those_of_brute_force(edged_brick):
    body = tile(edged_brick, (2, 1), (False, False))
    apart = np.linalg.norm(body.positions[None] - body.positions[:, None], axis=2)
    touching = np.triu(apart <= body.radii[:, None] + body.radii + 1e-9 * 0.25, k=1)
    found = {tuple(sorted(pair)) for pair in body.pairs.tolist()}
    assert found == set(map(tuple, np.argwhere(touching).tolist()))
    assert len(found) == len(body.pairs)


def test_rows_frame_the_scene_on_all_open_sides(edged_brick):
    body = tile(edged_brick, (2, 3), (False, False))
    for axis, row in ((0, 0), (1, 1)):
        for edge in (0.0, body.size[axis]):
            line = np.flatnonzero(body.positions[:, axis] == edge)
            along = np.sort(body.positions[line, 1 - axis])
            assert along[0] == 0.0
            assert along[-1] == body.size[1 - axis]
            assert np.all(edged_brick.edge_rows[body.brick_particle[line], row])
            ring = np.count_nonzero(edged_brick.edge_rows[:, row])
            assert len(line) == ring * body.copies[1 - axis] + 1
    assert np.all(body.positions <= body.size)
    count = len(edged_brick.radii)
    on_x, on_y = np.count_nonzero(edged_brick.edge_rows, axis=0)
    assert len(tile(edged_brick, (2, 3), (False, True)).radii) == 6 * count + 3 * on_x
    assert len(tile(edged_brick, (2, 3), (False, False)).radii) == 6 * count + 3 * on_x + 2 * on_y + 1


def test_what_is_left_is_what_was_there(dense_brick):
    body = tile(dense_brick, (3, 2), (True, False))
    removed = np.hypot(*(body.positions - body.size / 2.0).T) < 4.0
    left, kept = body.without(removed)
    assert np.all(np.diff(kept) > 0)
    assert not removed[kept].any()
    assert len(kept) + np.count_nonzero(removed) + left.loose - body.loose == len(body.radii)
    for name in ("positions", "radii", "brick_particle"):
        assert np.array_equal(getattr(left, name), getattr(body, name)[kept])
    among = np.isin(body.pairs, kept).all(axis=1)
    assert np.array_equal(kept[left.pairs], body.pairs[among])
    assert np.array_equal(left.contact_type, body.contact_type[among])
    assert left.pairs.dtype == body.pairs.dtype


def test_of_a_body_cut_in_two_the_larger_part_is_left(square):
    body = tile(square, (7, 2), (False, False))
    column = np.floor(body.positions[:, 0])
    left, kept = body.without(column == 2)
    assert set(column[kept]) == {3, 4, 5, 6}
    assert left.loose == 4
    # a second cut counts on top of the first
    assert left.without(column[kept] == 5)[0].loose == 6
    whole, kept = body.without(np.zeros(14, dtype=bool))
    assert whole is body
    assert kept.tolist() == list(range(14))
    with pytest.raises(PackingError, match="no disk is left"):
        body.without(np.ones(14, dtype=bool))


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
def any_brick(request) -> Brick:
    return request.getfixturevalue(f"{request.param}_brick")


def test_column_and_body_stand_side_by_side_in_one_assembly(dense_brick):
    body = tile(dense_brick, (2, 3), OPEN)
    column = tile(dense_brick, (1, 3), (True, False))
    joint, (seam,) = with_columns(dense_brick, body, (Standing(BOTH),))

    assert seam.disks.stop == len(column.radii)
    assert seam.width == dense_brick.size[0]
    assert np.array_equal(joint.positions[seam.disks.stop :], body.positions)
    for name in ("radii", "brick_particle", "contact_type"):
        assert np.array_equal(getattr(joint, name), np.concatenate([getattr(column, name), getattr(body, name)]))
    assert np.array_equal(joint.pairs, np.concatenate([column.pairs, body.pairs + seam.disks.stop]))
    assert joint.pairs.dtype == body.pairs.dtype
    # the scene is the body's; the column is out of its way
    assert np.array_equal(joint.size, body.size)
    assert (joint.positions[: seam.disks.stop, 0] + joint.radii[: seam.disks.stop]).max() < (
        body.positions[:, 0] - body.radii
    ).min()


def test_disks_that_a_side_cuts_loose_stand_in_the_column_and_others_are_refused(dangling_brick, random_brick):
    body = tile(dangling_brick, (2, 1), OPEN)
    joint, (seam,) = with_columns(dangling_brick, body, (Standing(BOTH),))
    assert body.loose == joint.loose == 1
    assert seam.disks.stop == 3
    # a row of the first disk is the larger part of a wide body, a stack of the second that of a column
    brick = made_by_hand((1.0, 1.0), [0.3, 0.2], [(0, 0, 1, 0), (1, 1, 0, 1)])
    with pytest.raises(PackingError, match="4 disks of the body have no twin in the free-field column"):
        with_columns(brick, tile(brick, (4, 2), OPEN), (Standing(BOTH),))
    for rows in ((-1, 7), (5, 7)):
        with pytest.raises(PackingError, match="have no twin in the free-field column"):
            with_columns(random_brick, tile(random_brick, (2, 3), OPEN), (Standing(BOTH),), rows)


def test_a_column_of_more_rows_than_the_body_has_its_twins_at_the_same_height(dense_brick):
    body = tile(dense_brick, (2, 3), OPEN, (30.0, 2 * dense_brick.size[1]))
    joint, (seam,) = with_columns(dense_brick, body, (Standing(BOTH),), rows=(2, 7), beside=(-5.0, 0.0, 40.0))
    count = seam.disks.stop
    assert count == joint.columns[0].disks.stop == len(tile(dense_brick, (1, 7), (True, False)).radii)
    assert joint.columns[0].copies == (1, 7)
    body_y, twin_y = joint.positions[count:, 1], joint.positions[seam.twin[count:], 1]
    np.testing.assert_allclose(twin_y, body_y, rtol=0.0, atol=1e-12)
    assert np.array_equal(joint.brick_particle[seam.twin], joint.brick_particle)
    assert joint.positions[:count, 0].max() < -5.0  # to the left of all that is there
    part = joint.part(slice(0, count))
    assert part.size.tolist() == (dense_brick.size * (1, 7)).tolist()
    assert part.origin[1] == 0.0
    assert np.array_equal(joint.part(slice(count, len(joint.radii))).origin, body.origin)


@pytest.mark.parametrize("rows", [(2, 7), (0, 5)], ids=["in the middle", "at the foot"])
def test_beyond_all_four_sides_are_the_column_s_own_disks(any_brick, rows):
    """Every cut contact is one of the column; where the column ends there is none beyond."""
    body = tile(any_brick, (3, 3), OPEN, (0.0, rows[0] * float(any_brick.size[1])))
    joint, (seam,) = with_columns(any_brick, body, (Standing(("left", "right", "bottom", "top")),), rows)
    owner, other, vectors = seam.pairs(any_brick)
    column = tile(any_brick, (1, rows[1]), (True, False))
    up = column.tile[other, 1] - column.tile[owner, 1]
    node = np.repeat(seam.node, seam.contact_counts)
    place = joint.tile[node] + np.stack([seam.image, up], axis=1)
    beyond = (place < 0) | (place > 2 + any_brick.edge_rows[joint.brick_particle[other]])  # those close the frame
    assert beyond.any(axis=1).all()
    assert (place[:, 1] < 0).any() == (rows[0] > 0)
    assert (beyond[:, 1] & (place[:, 1] > 0)).any() == (rows[0] + 3 < rows[1])
    assert np.array_equal(joint.brick_particle[owner], joint.brick_particle[node])
    if any_brick.positions.any():  # not of those made by hand
        ways = column.positions[other] - column.positions[owner] + seam.image[:, None] * [seam.width, 0.0]
        np.testing.assert_allclose(ways, vectors, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("size", [0.1, 1.0 / 3.0])
def test_places_between_rows_have_the_lower_disk_of_the_column(size):
    """However far away they are, where their coordinates are rounded otherwise."""
    brick = Square(pattern="A", size=(2 * size, 9 * size), radius=0.5 * size).pack(1.0)
    joint, _ = with_columns(brick, tile(brick, (2, 9), (False, False)), (Standing(("left", "right")),))
    rows = np.arange(1, 9)
    for away in (0.0, 77.5, -1e4):
        found = nearest_in_column(joint, size * np.column_stack([np.full(8, away), rows]))
        np.testing.assert_allclose(joint.positions[found, 1], size * (rows - 0.5), rtol=1e-12)

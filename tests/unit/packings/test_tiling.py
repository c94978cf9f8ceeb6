"""Assemblies: counts, numbering, geometry and the frame."""

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.packings import Square
from dembound.packings.tiling import tile


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

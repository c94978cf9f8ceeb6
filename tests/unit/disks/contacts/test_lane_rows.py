"""Rows of copies: every contact is in one entry or among the strays, and what they do is what the contacts do."""

import numpy as np
import pytest

from dembound.disks.contacts.lane_rows import matrices
from dembound.disks.contacts.row_plan import plan_rows
from dembound.disks.contacts.rows import elastic_constants
from dembound.disks.scene import DiskScene, build
from dembound.kernels.elastic import contact_forces
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import LaneRows

LATTICE = {"pattern": "A", "size": [9.0, 2.0], "radius": 0.25}
DENSE = {"pattern": "B", "size": [36.0, 10.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 5.0]}
FRAMED = {**DENSE, "pattern": "C", "edge_radius": 0.25, "size": [12.0, 15.0]}
WRAP = {"type": "periodic"}
FREE_FIELD = {"type": "free_field"}
HOLE = {"name": "tunnel", "type": "circle", "centre": [6.0, 5.0], "radius": 2.5}
BARE = {"wave": {}, "monitor": [], "motion.held": [], "boundary": {}}
CASES = {
    "lattice": {"packing": LATTICE},
    "half cells": {"packing": LATTICE, "boundary": {"right": {"type": "viscous", "half_mass": True}}},
    "lattice around": {"packing": LATTICE, "boundary": {"left": WRAP, "right": WRAP}},
    "dense": {"packing": DENSE},
    "dense around": {"packing": DENSE, "boundary": dict.fromkeys(("left", "right", "bottom", "top"), WRAP)},
    "framed": {"packing": FRAMED},
    "with a hole": {"packing": DENSE, "hole": [HOLE]},
    "free field": {"packing": DENSE, "boundary": {"left": FREE_FIELD, "right": FREE_FIELD}},
}


@pytest.fixture(params=CASES)
def scene(bar, request) -> DiskScene:
    return build(bar({**BARE, **CASES[request.param]}))


def lanes_of(scene: DiskScene) -> list[LaneRows]:
    return [rows for rows in scene.rows if isinstance(rows, LaneRows)]


def contacts_of(rows: LaneRows, slots: int) -> np.ndarray:
    """Owner slot and shift to the neighbour of every contact end (e, 2) of entries and strays."""
    found = []
    for group, (begin, end) in enumerate(zip(rows.group_row[:-1], rows.group_row[1:], strict=True)):
        columns = (rows.group_block[group + 1] - rows.group_block[group]) // (end - begin)
        for row in range(begin, end):
            for e in range(rows.start[row, 0], rows.start[row + 1, 0]):
                assert (rows.mask[e] < 0) == (e < rows.start[row, 1])
                for column in range(columns):
                    block = rows.group_block[group] + column * (end - begin) + row - begin
                    byte = 255 if rows.mask[e] < 0 else rows.masks[rows.mask[e] + column]
                    lanes = np.flatnonzero(np.unpackbits(np.uint8(byte), bitorder="little"))
                    found.append(np.column_stack([LANES * block + lanes, np.full(len(lanes), rows.shift[e])]))
    counts = np.diff(rows.stray_start)
    owner = np.repeat(rows.stray, counts)
    found.append(np.column_stack([owner, rows.stray_neighbour.astype(np.int64) - owner]))
    return np.concatenate(found)


def test_every_end_of_a_contact_is_in_one_entry_or_a_stray(scene: DiskScene) -> None:
    slot = scene.layout.slot
    i, j = slot[scene.assembly.pairs.T]
    first = min(LANES * rows.group_block[0] for rows in lanes_of(scene))  # a column of few copies keeps its order
    expected = sorted([*zip(i, j - i, strict=True), *zip(j, i - j, strict=True)])
    expected = [(owner, shift) for owner, shift in expected if owner >= first]
    found = np.concatenate([contacts_of(rows, scene.layout.count) for rows in lanes_of(scene)])
    there = scene.layout.node >= 0

    # entries that all copies have are in empty lanes too, between slots without disks
    empty = ~there[found[:, 0]]
    assert not there[found[empty].sum(axis=1)].any()
    assert sorted(map(tuple, found[~empty].tolist())) == expected


def test_disks_have_slots_of_their_own_in_rows_of_their_copies(scene: DiskScene) -> None:
    slot, assembly = scene.layout.slot, scene.assembly
    assert len(np.unique(slot)) == scene.count
    assert slot.min() >= LANES
    assert slot.max() < scene.layout.count - LANES
    for name, nodes in scene.parts.items():
        part = assembly.part(nodes)
        plan = plan_rows(part)
        key = plan.row * 1000 + part.brick_particle
        assert len(np.unique(key)) == len(np.unique(plan.row)), name


def test_forces_are_those_of_the_contacts_one_by_one(scene: DiskScene, in_order) -> None:
    plain = in_order(scene)
    u = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    found, expected = (each.system(1.0).forces.elastic(u) for each in (scene, plain))

    assert lanes_of(scene)
    assert not lanes_of(plain)
    # some ten sums of products of size k
    stiffest = scene.ground.stiffness.normal.max()
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=40.0 * np.finfo(float).eps * stiffest)


def test_a_body_that_moves_as_a_whole_feels_no_force(scene: DiskScene) -> None:
    u = scene.layout.spread(np.outer([0.3, -0.7, 0.0], np.ones(scene.count)))
    force = np.zeros_like(u)
    for rows in scene.rows:
        contact_forces(u, rows, force)

    assert not force[:, scene.layout.slot].any()


def test_slots_without_disks_stay_at_rest(scene: DiskScene) -> None:
    u = scene.layout.spread(np.random.default_rng(1).uniform(-1.0, 1.0, (3, scene.count)))
    force = np.zeros_like(u)
    for rows in scene.rows:
        contact_forces(u, rows, force)

    assert not force[:, scene.layout.node < 0].any()


def test_one_brick_alone_keeps_the_order_of_its_disks(bar) -> None:
    scene = build(bar({**BARE, "packing": {**DENSE, "size": [4.0, 5.0]}}))

    assert scene.layout.is_plain
    assert not lanes_of(scene)


def test_matrices_are_the_law_multiplied_out(bar) -> None:
    scene = build(bar({**BARE, "packing": DENSE}))
    table, _ = elastic_constants(scene.ground)
    rng = np.random.default_rng(3)
    dx, dy, turn, turn_j = rng.uniform(-1.0, 1.0, (4, len(table)))
    px, py, ratio, arm, arm_j, bending = table.T
    normal, shear = px * dx + py * dy, ratio * (px * dy - py * dx) - arm * turn - arm_j * turn_j
    expected = (
        px * normal - py * ratio * shear,
        py * normal + px * ratio * shear,
        arm * shear + bending * (turn_j - turn),
    )
    m = matrices(table).T
    found = (
        m[0] * dx + m[1] * dy + m[3] * turn_j + m[8] * turn,
        m[1] * dx + m[2] * dy + m[4] * turn_j + m[9] * turn,
        m[5] * dx + m[6] * dy + m[7] * turn_j + m[10] * turn,
    )

    # a few products of size k
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-14 * np.abs(table).max() ** 2)

"""Rows of copies: every contact is in one entry or among the strays, and what they do is what the contacts do."""

import numpy as np
import pytest

from dembound.disks.scene import DiskScene, build
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


def test_forces_are_those_of_the_contacts_one_by_one(scene: DiskScene, in_order) -> None:
    plain = in_order(scene)
    u = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    found, expected = (each.system(1.0).forces.elastic(u) for each in (scene, plain))

    assert lanes_of(scene)
    assert not lanes_of(plain)
    # some ten sums of products of size k
    stiffest = scene.ground.stiffness.normal.max()
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=40.0 * np.finfo(float).eps * stiffest)


def test_one_brick_alone_keeps_the_order_of_its_disks(bar) -> None:
    scene = build(bar({**BARE, "packing": {**DENSE, "size": [4.0, 5.0]}}))

    assert scene.layout.is_plain
    assert not lanes_of(scene)

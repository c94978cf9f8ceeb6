"""Rows of copies do what their contacts do one by one."""

import numpy as np
import pytest

from dembound.disks.scene import DiskScene, build
from dembound.kernels.tables import LaneRows

LATTICE = {"pattern": "A", "size": [9.0, 2.0], "radius": 0.25}
DENSE = {"pattern": "B", "size": [36.0, 10.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 5.0]}
WRAP = {"type": "periodic"}
HOLE = {"name": "tunnel", "type": "circle", "centre": [6.0, 5.0], "radius": 2.5}
BARE = {"wave": {}, "monitor": [], "motion.held": [], "boundary": {}}
CASES = {
    "lattice around": {"packing": LATTICE, "boundary": {"left": WRAP, "right": WRAP}},
    "dense": {"packing": DENSE},
    "dense around": {"packing": DENSE, "boundary": dict.fromkeys(("left", "right", "bottom", "top"), WRAP)},
    "with a hole": {"packing": DENSE, "hole": [HOLE]},
}
"""Runs of others are compared in `test_rows_of_copies`."""


def lanes_of(scene: DiskScene) -> list[LaneRows]:
    return [rows for rows in scene.rows if isinstance(rows, LaneRows)]


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_forces_are_those_of_the_contacts_one_by_one(bar, in_order, changes: dict) -> None:
    scene = build(bar({**BARE, **changes}))
    plain = in_order(scene)
    u = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    found, expected = (each.system(1.0).forces.elastic(u) for each in (scene, plain))

    assert lanes_of(scene)
    assert not lanes_of(plain)
    # some ten sums of products of size k
    stiffest = scene.ground.stiffness.normal.max()
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=40.0 * np.finfo(float).eps * stiffest)

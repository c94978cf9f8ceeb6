"""Forces of faces: those of springs in small motion, equal and opposite, and the pairs that are listed."""

import numpy as np
import pytest
import tomli_w
from small_cases import GRAINS, PUSHED

from dembound.disks.faces.springs import filling_springs
from dembound.disks.faces.tie import JointTie
from dembound.disks.scene import build
from dembound.kernels.joint_notes import PAIRS
from dembound.kinds import loads

LINE = [[-1.0, 0.8], [11.0, 1.6]]


def tie_in(tables, **keys):
    """A scene with an oblique joint, and its tie."""
    joint = {"name": "joint", "points": LINE, "kn": 1e10, "ks": 4e9} | keys
    scene = build(loads(tomli_w.dumps(tables | {"joint": [joint], "boundary": {}, "wave": {}, "monitor": []})))
    gives = scene.moves / np.stack([scene.mass, scene.mass, scene.inertia])
    return scene, JointTie(scene.faces[0], scene.positions, scene.ground, gives, scene.layout, 1e-4)


@pytest.mark.parametrize("tables", [PUSHED, GRAINS])
def test_small_motion_meets_the_springs_of_the_step_limit(tables):
    scene, tie = tie_in(tables)
    moved = 1e-9 * np.random.default_rng(2).normal(size=(3, scene.count))
    expected = np.zeros((3, scene.layout.count))
    filling_springs(scene.faces, scene.positions, scene.layout.slot)(scene.layout.spread(moved), expected)
    expected = scene.layout.gather(expected)
    found = tie.force_at(moved)
    # overlaps change by 1e-9 of some 0.1 m, which is of the second order
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())


def test_forces_are_in_balance_also_far_from_the_start():
    scene, tie = tie_in(GRAINS, fric=0.4)
    left = scene.faces[0].side > 0
    moved = np.zeros((3, scene.count))
    moved[:2, left] = np.array([[1.3], [0.08]])  # along the line, and 7 mm into the other side
    force = tie.force_at(moved)
    place = scene.positions.T + moved[:2]
    assert np.abs(force).max() > 1e4
    size = np.abs(force[:2]).sum()
    np.testing.assert_allclose(force[:2].sum(axis=1), 0.0, atol=1e-12 * size)
    torque = np.sum(place[0] * force[1] - place[1] * force[0]) + force[2].sum()
    np.testing.assert_allclose(torque, 0.0, atol=0.02 * size)  # shear, 7 mm from one of the two faces
    assert np.array_equal(tie.force_at(moved), force)  # what it remembers stays as it was


def test_pairs_that_are_near_are_listed_and_no_others():
    scene, tie = tie_in(PUSHED)
    pairs, faces = tie.bundle(np.arange(scene.count)).pairs, scene.faces[0]
    count = int(tie.bundle(np.arange(scene.count)).counts[PAIRS])
    middle = np.sum(faces.ends.mean(axis=1) * faces.along, axis=1)
    half = 0.5 * np.hypot(*(faces.ends[:, 1] - faces.ends[:, 0]).T)
    one, other = np.arange(faces.split)[:, None], np.arange(faces.split, len(faces.disk))[None]
    near = np.abs(middle[one] - middle[other]) < half[one] + half[other] + 0.25 * 0.5
    expected = np.argwhere(near) + np.array([0, faces.split])
    assert np.array_equal(np.stack([pairs.first, pairs.second], axis=1)[:count], expected)

"""The elastic law passes on neither force nor moment, resists no rigid motion, and is symmetric."""

import numpy as np
import pytest

EPS = np.finfo(float).eps


@pytest.fixture(scope="module", params=["A", "B", "C"])
def body(request, lab):
    """A free body, a random displacement of its particles, and the forces that answer."""
    scene = lab.scene(request.param, (20.0, 10.0), held=(), material={"fric": 0.5})
    u = 1e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, (3, scene.count))
    return scene, u, lab.forces(scene, u)


def moments(scene, force):
    """Moment about the origin (n,) N·m that each particle's force and moment make."""
    x, y = scene.assembly.positions.T
    return np.stack([x * force[1], -y * force[0], force[2]])


def rounding(terms: np.ndarray) -> float:
    """What a sum of forces may be off by.

    A force sums some ten products and `terms` are summed in turn: less than 100 ε of their sizes, whatever the signs.
    """
    return 100.0 * EPS * float(np.abs(terms).sum())


def test_forces_balance(body):
    _, _, force = body
    for direction in (0, 1):
        assert abs(force[direction].sum()) < rounding(force[direction])


def test_moments_balance(body):
    """Contact points lie on the line of centres and arms add up to the distance, so no couple is left."""
    scene, _, force = body
    terms = moments(scene, force)
    assert abs(terms.sum()) < rounding(terms)


@pytest.mark.parametrize("motion", ["along x", "along y", "rotation"])
def test_rigid_motion_meets_no_force(lab, body, motion):
    scene, u, force = body
    x, y = scene.assembly.positions.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    rigid = {"along x": [one, zero, zero], "along y": [zero, one, zero], "rotation": [-y, x, one]}[motion]
    answer = np.abs(lab.forces(scene, 1e-3 * np.array(rigid))).max(axis=1)
    # `force` answers differences of the size of u; here they cancel to the rounding of positions of up to 20 m,
    # and positions of disks across a brick's seam carry a few ε of 20 m themselves
    scale = np.abs(force).max(axis=1) * 1e-3 * 20.0 / np.abs(u).max()
    assert np.all(answer < 100.0 * EPS * scale)


def test_forces_are_reciprocal(lab, body):
    """Betti: the forces of u work on w as those of w on u, for every pair; K is symmetric and not negative."""
    scene, u, force = body
    w = 1e-3 * np.random.default_rng(2).uniform(-1.0, 1.0, u.shape)
    one, other = w * force, u * lab.forces(scene, w)
    assert abs(one.sum() - other.sum()) < rounding(one) + rounding(other)
    assert np.sum(u * force) < 0.0

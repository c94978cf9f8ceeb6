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


def rounding(terms: np.ndarray) -> float:
    """Rounding error of a sum of forces.

    A force sums some ten products and `terms` are summed in turn: less than 100 ε of their sizes, whatever the signs.
    """
    return 100.0 * EPS * float(np.abs(terms).sum())


def test_forces_and_moments_balance_and_are_reciprocal(lab, body):
    """Contact points lie on the line of centres and arms add up to the distance, so no couple is left.

    Betti: the forces of u work on w as those of w on u, for every pair; K is symmetric and not negative.
    """
    scene, u, force = body
    x, y = scene.assembly.positions.T
    moments = np.stack([x * force[1], -y * force[0], force[2]])
    for terms in (force[0], force[1], moments):
        assert abs(terms.sum()) < rounding(terms)
    w = 1e-3 * np.random.default_rng(2).uniform(-1.0, 1.0, u.shape)
    one, other = w * force, u * lab.forces(scene, w)
    assert abs(one.sum() - other.sum()) < rounding(one) + rounding(other)
    assert np.sum(u * force) < 0.0


def test_rigid_motion_meets_no_force(lab, body):
    scene, u, force = body
    x, y = scene.assembly.positions.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    # `force` answers differences of the size of u; here they cancel to the rounding of positions of up to 20 m,
    # and positions of disks across a brick's seam carry a few ε of 20 m themselves
    scale = np.abs(force).max(axis=1) * 1e-3 * 20.0 / np.abs(u).max()
    for rigid in ([one, zero, zero], [zero, one, zero], [-y, x, one]):
        assert np.all(np.abs(lab.forces(scene, 1e-3 * np.array(rigid))).max(axis=1) < 100.0 * EPS * scale)

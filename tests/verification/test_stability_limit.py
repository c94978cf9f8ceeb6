"""The stability limit is sharp: bounded just below it, blown up just above."""

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, eigsh

from dembound.disks.stability import OPENING, step_limit
from dembound.motion.simulation import Simulation
from dembound.motion.stability import TOLERANCE
from dembound.packings.brick import Brick

PERIODIC = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")


def growth(lab, scene, share: float, steps: int) -> float:
    """Kinetic energy after some steps at a share of the limit, over that of the random start without strain."""
    simulation = Simulation(scene, share * step_limit(scene))
    start = scene.free[:, None] * np.random.default_rng(0).standard_normal((3, scene.count))
    simulation.state.velocity = start
    simulation.advance(steps)
    return np.sum(lab.inertia(scene) * simulation.state.velocity**2) / np.sum(lab.inertia(scene) * start**2)


def test_square_lattice_has_a_closed_form(lab):
    """ω² = 16k_s/m on the endless lattice with y held: all disks turn alike and all four contacts shear.

    With k_n = K and k_s = k_r·3/R² = K/2 (bonds alone carry shear), unit m, and s = sin², c = cos² of half the phases
    from disk to disk, x has 4K(s_x + s_y/2), rotation 4K(c_x + c_y) + 4K(s_x + s_y)/3 and their coupling squared is
    8K² s_y c_y: 8K at zero phase, and both the trace and the other corners (6K) are below.
    """
    scene = lab.scene("A", (10.0, 10.0), boundary=PERIODIC)
    limit = lab.diameter / lab.speed / np.sqrt(2.0)  # 2/√(8K/m), and √(K/m) = c/D
    assert step_limit(scene) == pytest.approx(limit, rel=TOLERANCE)


GROUND = {"type": "viscoelastic", "distance": 1e-4}
"""Springs that are stiffer than contacts."""
SCENES = {
    "lattice, nothing held": ("A", (15.0, 15.0), {"held": ()}),
    "endless lattice": ("A", (10.0, 10.0), {"boundary": PERIODIC}),
    "random, rotation held": ("B", (20.0, 10.0), {"held": ("y", "rotation")}),
    "springs": ("B", (10.0, 10.0), {"held": (), "boundary": {"left": GROUND, "top": GROUND}}),
    "mirrors": ("C", (20.0, 10.0), {"held": (), "boundary": {"left": "symmetry", "right": "symmetry"}}),
    "half cells": ("C", (20.0, 10.0), {"held": (), "boundary": {"left": {"type": "viscous", "half_mass": True}}}),
    "column": ("C", (20.0, 10.0), {"held": (), "boundary": {"left": "free_field", "right": "free_field"}}),
}


def largest_eigenvalue(lab, scene) -> float:
    """ω² of the highest mode, from ARPACK's iteration to ten digits, with the scene's arrays in their plain order."""
    supports = scene.supports
    place = supports.component, supports.node
    springs, root = np.zeros((3, scene.count)), np.sqrt(scene.free[:, None] / lab.inertia(scene))
    springs[place] = supports.stiffness
    root[supports.component[supports.prescribed], supports.node[supports.prescribed]] = 0.0

    def apply(vector: np.ndarray) -> np.ndarray:
        u = root * vector.reshape(3, -1)
        return (root * (springs * u - lab.forces(scene, u))).ravel()

    operator = LinearOperator((root.size, root.size), matvec=apply, dtype=float)
    start = np.random.default_rng(1).standard_normal(root.size)
    return eigsh(operator, k=1, which="LA", v0=start, ncv=60, tol=1e-10, return_eigenvectors=False)[0]


@pytest.mark.parametrize("name", SCENES)
def test_limit_is_that_of_another_method_and_never_above(lab, name):
    pattern, size, words = SCENES[name]
    scene = lab.scene(pattern, size, **words)
    ratio = step_limit(scene) * np.sqrt(largest_eigenvalue(lab, scene)) / 2.0
    # the residual that is added to ω² is at most TOLERANCE, and half of it goes into the step; ARPACK errs by 1e-10
    assert 1.0 - 0.5 * TOLERANCE <= ratio <= 1.0 + 1e-10


def hexagonal(diameter: float) -> Brick:
    """Two touching disks of which copies make the hexagonal lattice, each disk with six neighbours."""
    size = diameter * np.array([1.0, np.sqrt(3.0)])
    pairs = np.array([[0, 0], [1, 1], [0, 1], [0, 1], [0, 1], [0, 1]])
    images = np.array([[1, 0], [1, 0], [0, 0], [-1, 0], [0, -1], [-1, -1]])
    nothing = np.zeros((2, 2), bool), np.zeros(3)
    return Brick(size, np.array([[0.0, 0.0], 0.5 * size]), np.full(2, 0.5 * diameter), pairs, images, *nothing, 0.0)


def test_limit_of_loose_disks_also_holds_where_they_come_to_lie_densely(lab):
    """A square lattice without bonds may fall into the hexagonal one, of which ω² = 24k_s/m where k_s ≥ k_n.

    There all disks turn alike: six contacts each shear by 2Rθ and turn back by k_s·2R²θ, and the moment of inertia is
    mR²/2. In the square lattice four contacts make it 16k_s/m; contacts that open need their reserve in either.
    """
    emod, kratio = 1.25e9, 0.5
    loose = {"emod": emod, "pb_emod": 0.0, "fric": 0.5, "kratio": kratio}
    square = lab.scene("A", (6.0, 6.0), held=(), material=loose | {"law": "linearpbond"}, boundary=PERIODIC)
    disk = lab.density * lab.diameter**2  # kg; the denser lattice is made of the same disks
    denser = loose | {"density": 2.0 / np.sqrt(3.0) * lab.density}
    dense = lab.tiled(hexagonal(lab.diameter), (6, 3), held=(), material=denser, boundary=PERIODIC)
    np.testing.assert_allclose([*square.mass, *dense.mass], disk, rtol=1e-14)

    limit = 2.0 / np.sqrt(24.0 * emod / kratio / disk)
    assert step_limit(dense) == pytest.approx(limit, rel=TOLERANCE)
    assert step_limit(square) < limit * np.sqrt(OPENING)


@pytest.mark.parametrize("pattern", ["A", "C"])
def test_bounded_below_the_limit_and_grows_above(lab, pattern):
    scene = lab.scene(pattern, (10.0, 10.0), boundary=PERIODIC)
    # ½mv² + ½uⁿKuⁿ⁺¹ is conserved and at least ½mv²(1 − r²) at the share r of the limit; Lanczos errs by TOLERANCE
    share = 0.999 * (1.0 + TOLERANCE)
    assert growth(lab, scene, 0.999, steps=2000) < 1.0 / (1.0 - share**2)
    # the highest mode's amplitude grows by (r + √(r² − 1))² = 1.09 per step, its energy by e^178 in 1000; it has one
    # of a few thousand parts of the energy at the start, and Lanczos errs on the unstable side. e^100 = 1e43
    assert growth(lab, scene, 1.001, steps=1000) > 1e40

"""A strip, partly of particles and partly of continuum, stretches evenly and stays straight under tension along it.

It does if the continuum has the packing's stiffness, and free surfaces at the depths of its skins: thicker, it would
stretch less than the particles; higher, the strip would bend.
"""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, cg

from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import fill_forces
from dembound.kinds import with_changes

LENGTH, HEIGHT = 20.0, 10.0  # m, of the particles; 40 m of continuum are at either end


@pytest.fixture(scope="module")
def strip(lab) -> Callable[[], DiskScene]:
    """Builds two bricks of 20 diameters with elements of 5 m beside them."""
    ends = {"left": "outside", "right": "outside"}
    case = lab.case("B", (LENGTH, HEIGHT), held=(), seed=3, material={"fric": 0.5}, boundary=ends)
    case = with_changes(case, {"outside": {"element": 5.0, "margin": 6, "layers": 2}})
    return lambda: build(case)


def under_tension(scene: DiskScene) -> np.ndarray:
    """The displacement gradient (2, 2) of the continuum under a unit strain along x without stress across it."""
    tensor = scene.ground.material_tensor
    across, shear = -np.linalg.solve(tensor[1:3, 1:3], tensor[1:3, 0])
    return np.array([[1.0, shear], [0.0, across]])


def at_rest(scene: DiskScene) -> np.ndarray:
    """Displacements (2, n) in equilibrium, where the strip's ends move as the continuum under tension."""
    assert scene.outside is not None
    add = scene.outside.adds_forces(scene.layout)
    moves = scene.moves.copy()
    root = np.sqrt(np.stack([scene.mass, scene.mass, scene.inertia]))[moves]

    def forces(u: np.ndarray) -> np.ndarray:
        """Forces on all that moves at displacements (3, n), over the roots of masses."""
        slots = scene.layout.spread(u)
        force = np.zeros_like(slots)
        fill_forces(scene, slots, force)
        add(slots, force, 1.0)
        return np.asarray(scene.layout.gather(force)[moves] / root)

    def stiffness(x: np.ndarray) -> np.ndarray:
        u = np.zeros(moves.shape)
        u[moves] = x / root
        return -forces(u)

    even = np.zeros(moves.shape)
    even[:2] = under_tension(scene) @ (scene.positions - 0.5 * scene.size).T
    size = int(moves.sum())
    found, failed = cg(LinearOperator((size, size), stiffness), forces(even), rtol=1e-6, maxiter=20_000)
    assert not failed
    even[moves] += found / root
    return even[:2]


def off(scene: DiskScene) -> np.ndarray:
    """Mean displacement (2,) of the continuum, 15 m left of the particles, beyond the even motion, over 10 m."""
    assert scene.outside is not None
    beyond = at_rest(scene) - under_tension(scene) @ (scene.positions - 0.5 * scene.size).T
    mesh = scene.outside.body.mesh
    across = scene.recorded + np.flatnonzero(np.isclose(mesh.positions[:, 0], mesh.sides[0] - 15.0))
    assert len(across) == 9
    return np.asarray(np.abs(beyond[:, across].mean(axis=1)) / 10.0)


def test_it_stretches_evenly_and_stays_straight_with_skins_at_their_depths(strip, monkeypatch) -> None:
    """Elongation measures the sum of both depths, which are 4.3 % of the height, and bending their difference.

    What is left comes from single bonds where both meet, some per cent of the strain over a disk: 0.2 % of 10 m.
    """
    depth = PackedMaterial.skin
    other = {"top": "bottom", "bottom": "top"}
    stretched, bent = off(strip())
    assert stretched < 3e-3
    assert bent < 1e-3
    monkeypatch.setattr(PackedMaterial, "skin", lambda ground, side: 0.0)
    assert stretched < 0.15 * off(strip())[0]
    monkeypatch.setattr(PackedMaterial, "skin", lambda ground, side: depth(ground, other[side]))
    assert bent < 0.1 * off(strip())[1]

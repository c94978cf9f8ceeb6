"""Layers of one packing: zones, springs in series, and joints at the heights asked for."""

import numpy as np
import pytest
import tomli_w

from dembound.casefile.disks.material import Material
from dembound.disks.material import layered as module
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.layered import LayeredGround, layered
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.packings.brick import Brick
from dembound.packings.square import Square

SOFT = Material(density=1800.0, p_wave_speed=300.0, fric=0.5)
STIFF = Material(density=2300.0, p_wave_speed=900.0, fric=0.5, kratio=2.0)


@pytest.fixture(scope="module")
def lattice() -> Brick:
    return Square(size=(1.0, 1.0), radius=0.5).pack(1e9)


def ground_of(brick: Brick, *materials: Material, joints: tuple[float, ...] = (10.0,)) -> LayeredGround:
    """The ground of materials from the bottom up, between joints."""
    return layered([make_packed_material(brick, each, (), 1) for each in materials], joints, 0.0)


def left_at(ground: LayeredGround, height: float) -> np.ndarray:
    """Effective heights, less that of a joint, in diameters, with the zones as they are."""
    strip = module._strip(ground.brick, height, 0.0)
    return module._heights(strip, ground.zones, height) / ground.brick.mean_diameter


def test_springs_across_a_joint_are_in_series(lattice) -> None:
    ground = ground_of(lattice, STIFF, SOFT)
    lower, upper = (ground.zones[number].material.stiffness for number in (1, 2))
    for pairing in ((1, 2), (2, 1)):
        found = ground.stiffness_of(pairing)
        # half of the normal spring of both is bond, with the same ratio in all layers, so that both together are in
        # series too; of the shear springs only contacts have the layer's ratio
        for name in ("normal", "bending"):
            one, other = getattr(lower, name), getattr(upper, name)
            np.testing.assert_allclose(getattr(found, name), 2.0 / (1.0 / one + 1.0 / other))


@pytest.mark.parametrize("height", [10.0, 10.3])
def test_corrections_move_the_joints_of_random_packings(random_brick, height) -> None:
    ground = ground_of(random_brick, STIFF, SOFT, joints=(height,))
    (joint,) = ground.joints
    diameter = random_brick.mean_diameter
    assert np.abs([joint.mass, joint.p, joint.s]).max() > 0.01 * diameter
    np.testing.assert_allclose(left_at(ground, height), 0.0, atol=1e-3)


def test_contacts_that_reach_across_a_zone_are_refused(lattice) -> None:
    with pytest.raises(CaseError, match="too thin"):
        ground_of(lattice, STIFF, SOFT, STIFF, joints=(10.0, 11.0))


TABLES = {
    "packing": {"pattern": "A", "size": [12.0, 16.0], "radius": 0.5},
    "material": {"density": 1800.0, "p_wave_speed": 300.0, "fric": 0.5},
    "layer": [{"thickness": 6.0}, {"density": 2300.0, "p_wave_speed": 900.0}],
    "boundary": {side: {"type": "free_field"} for side in ("left", "right")} | {"bottom": {"type": "viscous"}},
    "run": {"duration": 0.01},
}
DENSE = {"pattern": "B", "size": [36.0, 16.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}


@pytest.mark.parametrize("packing", [TABLES["packing"], DENSE], ids=["lattice", "dense"])
def test_rows_of_copies_have_the_forces_of_contacts_one_by_one(in_order, packing) -> None:
    scene = build(loads(tomli_w.dumps(TABLES | {"packing": packing})))
    plain = in_order(scene)
    assert not scene.layout.is_plain
    u = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    found, expected = (each.system(1.0).forces.elastic(u) for each in (scene, plain))
    stiffest = max(zone.material.stiffness.normal.max() for zone in scene.ground.zones)
    # some ten sums of products of size k
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=40.0 * np.finfo(float).eps * stiffest)


def test_masses_and_sides_are_those_of_the_layers() -> None:
    scene = build(loads(tomli_w.dumps(TABLES)))
    up = scene.positions[:, 1]
    np.testing.assert_allclose(scene.mass[up > 11.0], 1800.0)
    np.testing.assert_allclose(scene.mass[up < 4.0], 2300.0)
    table = scene.supports
    bottom = (table.damping > 0.0) & (table.component == 1) & (up[table.node] < 1.0)
    bottom &= np.abs(scene.positions[table.node, 0] - 6.0) < 5.0
    np.testing.assert_allclose(table.damping[bottom], 2300.0 * 900.0)


def test_a_disk_on_a_joint_is_above_it(lattice) -> None:
    ground = ground_of(lattice, STIFF, SOFT)
    assert ground.layer_of(np.array([[3.0, y] for y in (10.0 - 1e-3, 10.0 - 1e-9, 10.0, 11.0)])).tolist() == [
        1,
        0,
        0,
        0,
    ]
    assert ground.at(9.9).density == 2300.0
    assert ground.at(10.0).density == 1800.0

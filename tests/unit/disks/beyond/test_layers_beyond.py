"""The continuum round disks of layered ground: rows of elements, densities, and ties."""

import numpy as np
from small_cases import small

from dembound.continuum.medium import Layered, Medium
from dembound.disks.material.layered import LayeredGround
from dembound.disks.scene import DiskScene, build
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.mesh import medium_of
from dembound.packings.cut import cut_contacts

ROCK, SOIL = Medium.isotropic(2300.0, 1400.0, 700.0), Medium.isotropic(1800.0, 400.0, 200.0)
SIDES = ("left", "right", "bottom")


CASE = {
    "packing": {"pattern": "B", "bricks": [2, 3], "brick": [6.0, 6.0], "radius": 0.25, "radius_ratio": 1.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {side: {"type": "outside"} for side in SIDES},
    "outside": {"element": 4.0},
    "run": {"duration": 1.0},
}
SLOW = {"density": 2000.0, "p_wave_speed": 500.0}


def scene(*layers: dict[str, float], **changes: object) -> DiskScene:
    """A body of 12 m × 18 m in layers."""
    return build(small(CASE, changes=({"layer": list(layers)} if layers else {}) | changes))


def test_ties_have_the_springs_of_the_layer_of_their_disk() -> None:
    """Far from the joint: half a bond is twice as stiff as the bond of the layer, with the layer's correctors."""
    layered = scene(SLOW | {"thickness": 9.0}, {})
    ground, body = layered.ground, layered.assembly
    assert isinstance(ground, LayeredGround)
    cut = cut_contacts(ground.brick, body, SIDES)
    bonds = CutBonds.of(ground, cut, body.positions)
    for high, material in ((False, ground.layers[0].material), (True, ground.layers[1].material)):
        away = bonds.height > 9.0 + 3.0 if high else bonds.height < 9.0 - 3.0
        alone = CutBonds.of(material, cut, body.positions)
        assert away.any()
        for name in ("particle", "normal", "stiffness", "corrector", "force", "side"):
            np.testing.assert_array_equal(getattr(bonds, name)[..., away], getattr(alone, name)[..., away])


def test_media_and_densities_of_layers() -> None:
    layered = scene(SLOW | {"thickness": 9.0}, {})
    ground = medium_of(layered.ground)
    assert isinstance(ground, Layered)
    assert ground.joints == (9.0,)
    assert [each.density for each in ground.media] == [2500.0, 2000.0]

    body = layered.outside.body
    y = body.mesh.positions[:, 1]
    density = body.mass / body.mesh.areas
    inner = (y < y.max() - 0.1) & (np.abs(y - body.ground.joints[0]) > 0.1)
    np.testing.assert_allclose(density[inner], np.where(y[inner] > body.ground.joints[0], 2000.0, 2500.0))

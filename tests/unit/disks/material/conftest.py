"""A random brick that several tests look at, packed once."""

import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.brick import Brick
from dembound.packings.dense import Recipe, pack_dense


@pytest.fixture(scope="session")
def random_brick() -> Brick:
    return pack_dense(Recipe(size=(6.0, 5.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))


@pytest.fixture(scope="session")
def dense(random_brick) -> PackedMaterial:
    """Ground of such bricks, with friction."""
    return make_packed_material(random_brick, Material(density=2500.0, p_wave_speed=1000.0, fric=0.5), ())

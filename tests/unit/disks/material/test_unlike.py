"""Ground of unlike sides: zones and springs by place, contacts across the plane, and bricks of one side."""

from types import SimpleNamespace

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material.at_rest import levels_of
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.layered import layered
from dembound.disks.material.unlike import UnlikeGround
from dembound.errors import CaseError
from dembound.packings.square import Square
from dembound.packings.tiling import tile

BRICK = Square(size=(1.0, 1.0), radius=0.5).pack(1e9)
ROCK, SOFT, CLAY = (
    make_packed_material(BRICK, Material(density=density, p_wave_speed=speed, fric=0.5), (), 1)
    for density, speed in ((2300.0, 900.0), (1800.0, 300.0), (2000.0, 500.0))
)


@pytest.fixture(scope="module")
def ground() -> UnlikeGround:
    """Soft soil above y = 20 m left of x = 5 m, clay above 30 m right of it, and rock below."""
    sides = layered([ROCK, SOFT], [20.0], 0.0), layered([ROCK, CLAY], [30.0], 0.0)
    return UnlikeGround.of(sides, [(0, 2), (1, 2)], 5.0)


def test_disks_have_the_layer_of_their_side(ground) -> None:
    places = np.array([[4.9, 25.0], [5.0, 25.0], [5.0 - 1e-9, 35.0], [9.0, 35.0], [-3.0, 3.0], [8.0, 3.0]])
    assert ground.layer_of(places).tolist() == [0, 2, 1, 1, 2, 2]
    assert [material.density for material in ground.materials] == [1800.0, 2000.0, 2300.0]
    assert ground.at(25.0, 4.0) is ground.beside("left").at(25.0)
    assert ground.at(25.0, 6.0).density == 2300.0
    assert ground.at(3.0).density == 2300.0
    with pytest.raises(ValueError, match="not the same at both sides"):
        ground.at(25.0)
    assert ground.density == 1800.0  # of the slowest waves
    assert {zone.layer for zone in ground.undamped.zones} == {0, 1, 2}


def test_contacts_across_the_plane_are_in_series(ground) -> None:
    left, right = np.array([[4.5, 45.0]]), np.array([[5.5, 45.0]])
    one, other = (ground.stiffness_of((zone, zone)).normal for zone in ground.zone_of(np.vstack([left, right])))
    for pair in ((left, right), (right, left)):
        pairing = ground.pairings[int(ground.pairing_of(*pair)[0])]
        np.testing.assert_allclose(ground.stiffness_of(pairing).normal, 2.0 / (1.0 / one + 1.0 / other))
    with pytest.raises(CaseError, match="too thin"):
        ground.pairing_of(np.array([[4.5, 5.0]]), np.array([[5.5, 45.0]]))
    assert len(set(ground.pairings)) == len(ground.pairings)
    for number, (first, second) in enumerate(ground.pairings):
        assert ground._pairing[1][first, second] == number


def test_only_bricks_of_one_side_are_copies(ground) -> None:
    body = tile(BRICK, (10, 2), (False, False), (0.0, 24.0))
    found = levels_of(body, ground, None)
    number = {(round(x, 3), round(y, 3)): level for (x, y), level in zip(body.positions, found, strict=True)}
    lower = [number[x + 0.5, 24.5] for x in range(10)]
    assert len({*lower[:3]}) == len({*lower[7:]}) == 1
    assert len({*lower[3:7]} | {lower[0], lower[9]}) == 6
    assert {*lower}.isdisjoint(number[x + 0.5, 25.5] for x in range(10))
    same = SimpleNamespace(surface=None)
    np.testing.assert_array_equal(levels_of(body, ground, same), found)

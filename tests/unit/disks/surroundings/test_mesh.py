"""The continuum beyond sides that holes reach, and round disks of layered ground."""

from typing import Any

import numpy as np
import pytest
from small_cases import GROUND, small

from dembound.continuum.medium import Layered, Medium
from dembound.disks.material.layered import LayeredGround
from dembound.disks.scene import DiskScene, build
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.mesh import medium_of
from dembound.errors import CaseError
from dembound.packings.cut import cut_contacts

CASE = GROUND | {"material": GROUND["material"] | {"fric": 0.5}, "outside": {"element": 4.0}}


def scene(*points: tuple[float, float], **changes: Any) -> DiskScene:
    """30 m × 20 m of disks with a hole."""
    hole = {"name": "cut", "type": "polygon", "points": [list(point) for point in points]}
    return build(small(CASE, changes={"hole": [hole]} | changes))


def line(*points: tuple[float, float], **changes: Any) -> str:
    with pytest.raises(CaseError) as caught:
        scene(*points, **changes)
    (only,) = caught.value.problems
    return only


def slope(height: float, end: float = 31.0, last: float | None = None) -> list[tuple[float, float]]:
    """Corners from (10, 20) m down to a floor at this height, up to x = `end`, where it may have another height."""
    return [(10.0, 21.0), (18.0, height), (end, height if last is None else last), (end, 21.0)]


@pytest.mark.parametrize("height", [11.499999999, 11.500000001, 11.7])
def test_disks_below_a_floor_remain_and_are_tied(height: float) -> None:
    """A row with centres on the floor, within rounding, is below or above it for body and continuum alike."""
    made = scene(*slope(height))
    bonds, x = made.outside.wall.bonds, made.assembly.positions
    at_right = x[x[:, 0] == 29.5, 1]
    highest = at_right.max() + 0.5

    assert highest == (12.0 if height > 11.5 - 1e-8 and 11.5 in at_right else 11.0)
    assert (bonds.side == 1).sum() == highest
    assert made.outside.levels["right"].surface == pytest.approx(highest, abs=1e-9)
    assert made.outside.body.mesh.positions[made.outside.body.mesh.positions[:, 0] > 30.1, 1].max() == pytest.approx(
        highest, abs=1e-9
    )
    mass = made.outside.body.mass.sum() + made.mass[: made.disk_count].sum()
    whole = made.outside.body.mesh
    removed = 30.0 * 20.0 - len(made.assembly.radii)
    beyond = (whole.size[0] - 30.0) / 2.0
    assert mass == pytest.approx(2500.0 * (np.prod(whole.size) - removed - beyond * (20.0 - highest)), rel=1e-9)


def test_floors_that_the_continuum_cannot_have_are_refused() -> None:
    """At the side; a pillar there stands in the last row of disks, and the hole passes before it."""
    said = "reaches boundary.right, beyond which the ground is level: beside it the hole must take all disks down to"
    assert line(*slope(12.0, last=8.0)).startswith(f"hole[1, cut]: {said} one height, over at least 4 m (now 2.25 m at")
    pillar = [*slope(12.0, 28.9)[:3], (28.9, 14.0), (31.0, 14.0), (31.0, 17.0), (28.9, 17.0), (28.9, 21.0)]
    assert "hole[1, cut]: reaches boundary.right, where the continuum has no hole" in line(*pillar)


ROCK, SOIL = Medium.isotropic(2300.0, 1400.0, 700.0), Medium.isotropic(1800.0, 400.0, 200.0)
SIDES = ("left", "right", "bottom")


GRANULAR = {
    "packing": {"pattern": "B", "bricks": [2, 3], "brick": [6.0, 6.0], "radius": 0.25, "radius_ratio": 1.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {side: {"type": "outside"} for side in SIDES},
    "outside": {"element": 4.0},
    "run": {"duration": 1.0},
}
SLOW = {"density": 2000.0, "p_wave_speed": 500.0}


def ground_in(*layers: dict[str, float], **changes: object) -> DiskScene:
    """A body of 12 m × 18 m in layers."""
    return build(small(GRANULAR, changes=({"layer": list(layers)} if layers else {}) | changes))


def test_ties_have_the_springs_of_the_layer_of_their_disk() -> None:
    """Far from the joint: half a bond is twice as stiff as the bond of the layer, with the layer's correctors."""
    layered = ground_in(SLOW | {"thickness": 9.0}, {})
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
    layered = ground_in(SLOW | {"thickness": 9.0}, {})
    ground = medium_of(layered.ground)
    assert isinstance(ground, Layered)
    assert ground.joints == (9.0,)
    assert [each.density for each in ground.media] == [2500.0, 2000.0]

    body = layered.outside.body
    y = body.mesh.positions[:, 1]
    density = body.mass / body.mesh.areas
    inner = (y < y.max() - 0.1) & (np.abs(y - body.ground.joints[0]) > 0.1)
    np.testing.assert_allclose(density[inner], np.where(y[inner] > body.ground.joints[0], 2000.0, 2500.0))

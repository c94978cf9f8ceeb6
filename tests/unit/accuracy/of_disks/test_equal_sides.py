"""Sides of other types are estimated as sides of this package with equal supports per metre."""

from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
import pytest
from small_cases import Tables, small

from dembound.accuracy.of_disks.equal_sides import with_plain_sides
from dembound.boundaries import Boundary
from dembound.disks.matching import Held
from dembound.disks.scene import DiskScene, build, with_boundaries

GROUND: Tables = {
    "packing": {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 1, "bricks": [2, 1]},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {},
    "run": {"duration": 0.02},
    "output": {"pictures": False},
}


class Own(Boundary):
    """Dampers and springs along x and y, per metre of width or per disk, rising along the side by a share."""

    is_artificial: ClassVar[bool] = True

    type: Literal["own"] = "own"
    dampers: tuple[float, float] = (0.0, 0.0)
    springs: tuple[float, float] = (0.0, 0.0)
    per_disk: bool = False
    rising: float = 0.0

    def support(self, edge, medium, waves, supports):
        """Add dampers and springs."""
        each = np.ones(len(edge.nodes)) if self.per_disk else edge.widths
        each = each * (1.0 + self.rising * np.linspace(-0.5, 0.5, len(edge.nodes)))
        for component in (0, 1):
            damping, stiffness = self.dampers[component] * each, self.springs[component] * each
            supports.add(edge.nodes, component, damping=damping, stiffness=stiffness)


class Kept(Own):
    """A side like `Own` that does not represent ground beyond."""

    is_artificial: ClassVar[bool] = False


@pytest.fixture(scope="module")
def scene() -> DiskScene:
    return build(small(GROUND))


def with_side(scene: DiskScene, side: str, table: Boundary) -> DiskScene:
    return with_boundaries(scene, replace(scene.case, boundary={side: table}))


@pytest.mark.parametrize(
    ("side", "per_disk", "springs"),
    [("right", False, (0.0, 0.0)), ("right", True, (3e7, 7e7)), ("top", False, (3e7, 7e7))],
)
def test_dampers_and_springs_are_those_per_metre_along_each_axis(scene, side, per_disk, springs) -> None:
    given = with_side(scene, side, Own(dampers=(2e6, 5e6), springs=springs, per_disk=per_disk))
    plain = with_plain_sides(given)
    assert plain.case.boundary[side].type == ("viscoelastic" if any(springs) else "viscous")
    for one, other in zip(Held.of(given, side), Held.of(plain, side), strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-12)  # rounding


def test_sides_stay_that_differ_along_them_or_are_part_of_the_problem(scene) -> None:
    for table in (Own(dampers=(2e6, 5e6), rising=0.1), Kept(dampers=(2e6, 5e6)), Own()):
        given = with_side(scene, "right", table)
        assert with_plain_sides(given) is given
    known = build(small(GROUND, changes={"boundary.right": {"type": "viscoelastic", "distance": 3.0}}))
    assert with_plain_sides(known) is known

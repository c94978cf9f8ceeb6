"""The continuum round a body: its free edges, their nodes and forces."""

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import step_limit
from dembound.kinds.disks.facts import disk_facts

CASE = {
    "packing": {"pattern": "B", "bricks": [2, 1], "brick": [6.0, 6.0], "radius": 0.25, "radius_ratio": 1.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "outside": {"element": 4.0},
    "run": {"duration": 1.0},
}


def scene(*sides: str, **changes: object) -> DiskScene:
    """A body of 12 m × 6 m with a continuum on some sides."""
    return build(small(CASE, changes={"boundary": {side: {"type": "outside"} for side in sides}} | changes))


def test_free_edges_lie_a_skin_below_the_body() -> None:
    corner = scene("right", "bottom")
    mesh, skin = corner.outside.body.mesh, corner.ground.skin
    assert corner.outside.skins == {"left": skin("left"), "top": skin("top")}
    assert 0.05 < skin("left") < 0.5
    assert 0.05 < skin("top") < 0.5
    assert abs(skin("left") - skin("top")) > 1e-3
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    assert (low[0], high[1]) == pytest.approx((skin("left"), 6.0 - skin("top")), abs=1e-12)
    facts = dict(disk_facts(corner))
    assert (
        facts["its free edges"] == f"{skin('left'):.3f} m inside the left side, {skin('top'):.3f} m inside the top side"
    )
    # the sides with ties are where the mass ends, a whole number of elements from the free edges
    x, y = corner.ground.brick.mass_offset
    left, right, lower, upper = mesh.sides
    assert (left, right, lower, upper) == pytest.approx((skin("left"), 12.0 + x, y, 6.0 - skin("top")), abs=1e-12)
    sizes = (right - left) / 3, (upper - lower) / 2
    np.testing.assert_allclose(mesh.element_sizes, np.tile(sizes, (len(mesh.elements), 1)), rtol=1e-12)


def test_the_mass_up_to_where_that_of_the_packing_ends_is_kept() -> None:
    corner = scene("right", "bottom")
    mesh = corner.outside.body.mesh
    right, bottom = 4 * mesh.element_sizes[0]  # one element and three that absorb
    area = (12.0 + right) * (6.0 + bottom) - 12.0 * 6.0
    # at the corner of the two legs' outer ends nothing is doubled: edges end where elements end
    assert corner.outside.body.mass.sum() == pytest.approx(2500.0 * area, rel=1e-12)


def test_small_elements_keep_a_usable_step() -> None:
    """Elements of five disks have light nodes. With slopes taken at their edges the step would be 22 times smaller."""
    assert step_limit(scene("bottom", **{"outside.element": 2.5})) > 0.25 * step_limit(scene())

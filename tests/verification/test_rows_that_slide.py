"""Rows of disks that stand on each other slide at F = μ/tan α, and where they are pushed by μg cos α ∓ g sin α.

A square lattice of disks without bonds that do not turn, on a row of fixed ones; it is gravity that is tilted, by α, so
that its component along x pulls to the right. Every row bears the same ratio of shear to normal force, so all slide at
once, and on a lattice no force goes sideways.
"""

import numpy as np
import pytest
from small_cases import small

from dembound.studies.strength.study import GRAVITY, measure

FRICTION, ANGLE, TOLERANCE = 0.5, np.radians(10.0), 0.02
ALONG, ACROSS = GRAVITY * np.sin(ANGLE), GRAVITY * np.cos(ANGLE)

ROWS = {
    "packing": {"pattern": "A", "size": [2.0, 1.5], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 1.0, "fric": FRICTION}
    | {"law": "linearpbond"},
    "motion": {"held": ["rotation"]},
    "load": [{"name": "weight", "acceleration": [float(ALONG), float(-ACROSS)]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
    "run": {"duration": 0.1},
}


def test_the_factor_is_the_friction_over_the_slope_and_pushes_add_to_the_pull() -> None:
    """The numbers lie within their brackets, but for contacts that turn as they shear, by some 1e-4."""
    found = measure(small(ROWS), TOLERANCE)
    factor, right, left = (search.value for search in found.searches)

    half = 0.5 * TOLERANCE + 1e-3
    assert factor == pytest.approx(FRICTION / np.tan(ANGLE), rel=half)
    assert right == pytest.approx((FRICTION * ACROSS - ALONG) / GRAVITY, rel=half)
    assert left == pytest.approx((FRICTION * ACROSS + ALONG) / GRAVITY, rel=half)
    assert found.holds
    assert [search.tried[1].value < 0.0 for search in found.searches] == [False, False, True]

"""What a free-field side adds to the seam: dashpots on the velocity relative to the twin."""

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.boundaries import Fixed, FreeField, Viscous
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Supports

DIAMETERS = np.array([0.5, 1.0])
P, S = 2000.0 * 1000.0 * DIAMETERS, 2000.0 * 500.0 * DIAMETERS
"""ρ c D, N·s/m."""
TABLE = FreeField(type="free_field", beta_p=0.8, beta_s=0.4)


def still(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return 0.0 * diameters, 0.0 * diameters


def rows(*tables: FreeField | Fixed) -> Supports:
    """What tables make of a left side of two particles, 5 and 6."""
    builder = SupportBuilder()
    edge = Edge("left", np.array([5, 6]), np.zeros((2, 2)), DIAMETERS, 1.5)
    medium = BoundaryMedium(density=2000.0, p_wave_speed=1000.0, s_wave_speed=500.0, mirror_stiffness=still)
    for table in tables:
        table.support(edge, medium, {}, builder)
    return builder.table()


def test_dashpots_hold_on_to_the_free_field() -> None:
    supports = rows(TABLE)

    # Z eq. 21: C = βρcD on v − v_ff; products of the same factors in another order differ by rounding
    assert supports.node.tolist() == [5, 5, 6, 6]
    for component, expected in ((0, 0.8 * P), (1, 0.4 * S)):
        np.testing.assert_allclose(supports.damping[supports.component == component], expected, rtol=1e-15)
    assert np.array_equal(supports.follow, supports.damping)
    assert not supports.prescribed.any()
    assert not supports.stiffness.any()
    assert len(supports.drive) == 0


def test_a_fixed_particle_follows_nothing() -> None:
    supports = rows(TABLE, Fixed(type="fixed"))

    assert supports.prescribed.all()
    assert not supports.follow.any()
    assert not supports.damping.any()


def test_at_a_corner_only_the_free_fields_share_follows() -> None:
    supports = rows(TABLE, Viscous(type="viscous"))

    np.testing.assert_allclose(supports.damping[supports.component == 0], 1.8 * P, rtol=1e-15)
    np.testing.assert_allclose(supports.follow[supports.component == 0], 0.8 * P, rtol=1e-15)


def test_half_masses_are_not_for_a_free_field() -> None:
    assert not TABLE.half_mass
    with pytest.raises(ValidationError, match="half_mass: is not allowed on a free-field side"):
        FreeField(type="free_field", half_mass=True)


def test_without_its_column_it_is_viscous() -> None:
    assert TABLE.dashpots_alone() == Viscous(type="viscous", beta_p=0.8, beta_s=0.4)

"""Each boundary type fills the rows its formula says, on upright and on level sides."""

from collections.abc import Mapping

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.boundaries import BoundaryTable, Fixed, Free, Periodic, Velocity, Viscous, ViscousInput
from dembound.boundaries.support import Edge, Medium, Signal, SupportBuilder, Supports

MEDIUM = Medium(density=2000.0, p_wave_speed=1000.0, s_wave_speed=500.0)
DIAMETERS = np.array([0.5, 1.0])
P = 2000.0 * 1000.0 * DIAMETERS
"""ρ c_p D, N·s/m."""
S = 2000.0 * 500.0 * DIAMETERS
TIME = 3.0


def push(times: np.ndarray) -> np.ndarray:
    return times


def shake(times: np.ndarray) -> np.ndarray:
    return 10.0 * times


WAVES: Mapping[str, Signal] = {"push": push, "shake": shake}


def rows(table: BoundaryTable, side: str) -> Supports:
    """What a boundary table makes of a side of two particles, 5 and 6."""
    builder = SupportBuilder()
    table.support(Edge(side, np.array([5, 6]), DIAMETERS, 1.5), MEDIUM, WAVES, builder)
    return builder.table()


def column(supports: Supports, name: str, component: int) -> np.ndarray:
    """A column's values (2,) on one component of both particles."""
    values = supports.sample(np.array([TIME]), 0.0)[0] if name == "push" else getattr(supports, name)
    return values[supports.component == component]


@pytest.mark.parametrize("side", ["left", "top"])
@pytest.mark.parametrize("table", [Free(), Periodic(type="periodic")])
def test_free_and_periodic_sides_push_nothing(table: BoundaryTable, side: str) -> None:
    assert len(rows(table, side)) == 0


def test_a_fixed_side_stops_all_three_components() -> None:
    supports = rows(Fixed(type="fixed"), "right")

    assert supports.node.tolist() == [5, 5, 5, 6, 6, 6]
    assert supports.component.tolist() == [0, 1, 2, 0, 1, 2]
    assert supports.prescribed.all()
    assert not supports.sample(np.array([TIME]), 0.0).any()


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("right", 0), ("bottom", 1), ("top", 1)])
def test_a_viscous_side_has_dashpots_of_both_kinds(side: str, normal: int) -> None:
    supports = rows(Viscous(type="viscous", beta_p=0.8, beta_s=0.4), side)

    # Z eq. 4: C = βρcD; products of the same factors in another order differ by rounding
    np.testing.assert_allclose(column(supports, "damping", normal), 0.8 * P, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "damping", 1 - normal), 0.4 * S, rtol=1e-15)
    assert len(supports) == 4
    assert not supports.prescribed.any()
    assert not supports.stiffness.any()
    assert not supports.sample(np.array([TIME]), 0.0).any()


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("right", 0), ("bottom", 1), ("top", 1)])
def test_an_input_side_also_pushes_with_twice_the_incident_wave(side: str, normal: int) -> None:
    table = ViscousInput(type="viscous_input", beta_p=0.8, beta_s=0.4, wave_p="push", wave_s="shake")
    supports = rows(table, side)

    # Z eq. 6: 2βρcD·v_i, along +x or +y whatever the side
    np.testing.assert_allclose(column(supports, "damping", normal), 0.8 * P, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "push", normal), 2.0 * 0.8 * P * 3.0, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "push", 1 - normal), 2.0 * 0.4 * S * 30.0, rtol=1e-15)


def test_an_input_side_only_absorbs_in_the_direction_without_a_wave() -> None:
    supports = rows(ViscousInput(type="viscous_input", wave_s="shake"), "bottom")

    assert column(supports, "push", 1).tolist() == [0.0, 0.0]
    assert column(supports, "push", 0).tolist() == (2.0 * S * 30.0).tolist()
    assert column(supports, "damping", 1).tolist() == P.tolist()


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("top", 1)])
def test_a_driven_side_moves_with_its_wave_is_held_across_and_may_turn(side: str, normal: int) -> None:
    supports = rows(Velocity(type="velocity", wave_p="shake"), side)

    assert supports.prescribed.all()
    assert column(supports, "push", normal).tolist() == [30.0, 30.0]
    assert column(supports, "push", 1 - normal).tolist() == [0.0, 0.0]
    assert set(supports.component) == {0, 1}


@pytest.mark.parametrize("kind", [Velocity, ViscousInput])
def test_a_driven_side_must_name_a_wave(kind: type[Velocity] | type[ViscousInput]) -> None:
    name = "velocity" if kind is Velocity else "viscous_input"
    with pytest.raises(ValidationError, match="names no wave"):
        kind(type=name)

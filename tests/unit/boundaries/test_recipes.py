"""Each boundary type fills the rows its formula says, on upright and on level sides."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.boundaries import (
    Boundary,
    Fixed,
    Free,
    FreeField,
    Periodic,
    Roller,
    Symmetry,
    Velocity,
    Viscoelastic,
    ViscoelasticInput,
    Viscous,
    ViscousInput,
)
from dembound.boundaries.support import BoundaryMedium, Edge, Incident, SupportBuilder, Supports
from dembound.errors import CaseError


def mirror_stiffness(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.full(2, 7.0), 3.0 * diameters


MEDIUM = BoundaryMedium(density=2000.0, p_wave_speed=1000.0, s_wave_speed=500.0, mirror_stiffness=mirror_stiffness)
DIAMETERS = np.array([0.5, 1.0])
POSITIONS = np.array([[0.25, 4.0], [0.5, 3.0]])
P = 2000.0 * 1000.0 * DIAMETERS
"""ρ c_p D, N·s/m."""
S = 2000.0 * 500.0 * DIAMETERS
TIME = 3.0


class Ramp:
    """v = a·t, u = a·t²/2."""

    def __init__(self, slope: float) -> None:
        self.slope = slope

    def velocity(self, t: np.ndarray) -> np.ndarray:
        return self.slope * t

    def displacement(self, t: np.ndarray) -> np.ndarray:
        return 0.5 * self.slope * t**2


WAVES: Mapping[str, Incident] = {"push": Ramp(1.0), "shake": Ramp(10.0)}


def rows(table: Boundary, side: str) -> Supports:
    """What a boundary table makes of a side of two particles, 5 and 6."""
    builder = SupportBuilder()
    table.support(Edge(side, np.array([5, 6]), POSITIONS, DIAMETERS, 1.5), MEDIUM, WAVES, builder)
    return builder.table()


def column(supports: Supports, name: str, component: int) -> np.ndarray:
    """A column's values (2,) on one component of both particles."""
    values = supports.sample(np.array([TIME]), 0.0)[0] if name == "push" else getattr(supports, name)
    return values[supports.component == component]


@pytest.mark.parametrize("side", ["left", "top"])
@pytest.mark.parametrize("table", [Free(), Periodic(type="periodic")])
def test_free_and_periodic_sides_push_nothing(table: Boundary, side: str) -> None:
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


@pytest.mark.parametrize(
    "table",
    [
        Viscous(type="viscous"),
        ViscousInput(type="viscous_input", wave_p="push", beta_s="matched"),
        Viscoelastic(type="viscoelastic", distance=3.0),
        ViscoelasticInput(type="viscoelastic_input", wave_p="push", distance=3.0),
        FreeField(type="free_field"),
    ],
    ids=lambda table: table.type,
)
def test_matched_dashpots_have_the_impedance_of_the_packing(table: Boundary) -> None:
    builder, medium = SupportBuilder(), replace(MEDIUM, own_speeds=lambda: (900.0, 600.0))
    table.support(Edge("left", np.array([5, 6]), POSITIONS, DIAMETERS, 1.2), medium, WAVES, builder)
    supports = builder.table()

    # ρ c_eff H of both kinds of waves, on disks that cover 1.5 m of 1.2 m; an incident wave enters with twice that
    assert column(supports, "damping", 0).sum() == pytest.approx(2000.0 * 900.0 * 1.2, rel=1e-15)
    assert column(supports, "damping", 1).sum() == pytest.approx(2000.0 * 600.0 * 1.2, rel=1e-15)
    if table.waves:
        springs = column(supports, "stiffness", 0).sum() * 0.5 * TIME**2
        pushed = column(supports, "push", 0).sum() - springs
        assert pushed == pytest.approx(2.0 * 2000.0 * 900.0 * 1.2 * TIME, rel=1e-12)


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


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("top", 1)])
def test_a_roller_holds_the_normal_motion_alone(side: str, normal: int) -> None:
    supports = rows(Roller(type="roller"), side)

    assert supports.node.tolist() == [5, 6]
    assert supports.component.tolist() == [normal, normal]
    assert supports.prescribed.all()
    assert not supports.sample(np.array([TIME]), 0.0).any()


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("top", 1)])
def test_a_mirror_image_pushes_along_the_normal_and_turns_back(side: str, normal: int) -> None:
    supports = rows(Symmetry(type="symmetry"), side)

    # elongation 2u_n and bending 2θ on stiffnesses 7 and 3D
    assert column(supports, "stiffness", normal).tolist() == [14.0, 14.0]
    assert column(supports, "stiffness", 2).tolist() == [3.0, 6.0]
    assert len(supports) == 4
    assert not supports.damping.any()
    assert not supports.prescribed.any()


NEAR = {"alpha_n": 2.0, "alpha_s": 0.25, "distance": 40.0}
G = 2000.0 * 500.0**2
"""ρc_s², Pa."""


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("top", 1)])
def test_a_viscoelastic_side_has_springs_besides_the_dashpots(side: str, normal: int) -> None:
    supports = rows(Viscoelastic(type="viscoelastic", beta_p=0.8, beta_s=0.4, **NEAR), side)

    # Z eq. 17: K = αGD/L; products of the same factors in another order differ by rounding
    np.testing.assert_allclose(column(supports, "stiffness", normal), 2.0 * G * DIAMETERS / 40.0, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "stiffness", 1 - normal), 0.25 * G * DIAMETERS / 40.0, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "damping", normal), 0.8 * P, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "damping", 1 - normal), 0.4 * S, rtol=1e-15)
    assert len(supports) == 4
    assert len(supports.drive) == 0


@pytest.mark.parametrize(("given", "modulus"), [({}, 6e8), ({"poisson_ratio": 0.25}, 4.8e8)])
def test_springs_take_the_modulus_given(given: dict[str, float], modulus: float) -> None:
    table = Viscoelastic(type="viscoelastic", young_modulus=1.2e9, distance=40.0, **given)

    # G = E/(2(1 + ν)), α_n = 1 and α_s = 0.5 by default
    np.testing.assert_allclose(column(rows(table, "left"), "stiffness", 0), modulus * DIAMETERS / 40.0, rtol=1e-15)
    np.testing.assert_allclose(column(rows(table, "left"), "stiffness", 1), modulus * DIAMETERS / 80.0, rtol=1e-15)


def test_springs_weaken_with_each_particles_distance_from_the_source() -> None:
    supports = rows(Viscoelastic(type="viscoelastic", source=(3.25, 8.0)), "left")

    # 3-4-5 triangle, and hypot(2.75, 5)
    distances = np.array([5.0, np.sqrt(32.5625)])
    np.testing.assert_allclose(column(supports, "stiffness", 0), G * DIAMETERS / distances, rtol=1e-15)


def test_a_source_within_a_particle_of_the_side_is_refused() -> None:
    # the second particle's surface is 0.5 m from its centre
    with pytest.raises(CaseError, match=r"^boundary\.left\.source: lies in a particle"):
        rows(Viscoelastic(type="viscoelastic", source=(0.5, 3.49)), "left")
    assert len(rows(Viscoelastic(type="viscoelastic", source=(0.5, 2.49)), "left")) == 4


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("top", 1)])
def test_a_viscoelastic_input_side_also_holds_on_to_the_incident_displacement(side: str, normal: int) -> None:
    table = ViscoelasticInput(type="viscoelastic_input", beta_p=0.8, wave_p="push", wave_s="shake", **NEAR)
    supports = rows(table, side)
    springs = np.outer([2.0, 0.25], G * DIAMETERS / 40.0)

    # Z eq. 18: 2βρcD·v_i + KD·u_i with v_i = at and u_i = at²/2 at t = 3, a = 1 and 10
    np.testing.assert_allclose(column(supports, "push", normal), 2.0 * 0.8 * P * 3.0 + springs[0] * 4.5, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "push", 1 - normal), 2.0 * S * 30.0 + springs[1] * 45.0, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "damping", normal), 0.8 * P, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "stiffness", normal), springs[0], rtol=1e-15)
    assert len(supports) == 4


def test_a_viscoelastic_input_side_only_absorbs_and_holds_in_the_direction_without_a_wave() -> None:
    supports = rows(ViscoelasticInput(type="viscoelastic_input", wave_p="push", **NEAR), "bottom")

    assert column(supports, "push", 0).tolist() == [0.0, 0.0]
    assert column(supports, "stiffness", 0).all()


def test_a_viscoelastic_side_without_its_springs_is_viscous() -> None:
    dashpots = {"beta_p": 0.8, "beta_s": 0.4, "half_mass": True}

    assert Viscoelastic(type="viscoelastic", **dashpots, **NEAR).dashpots_alone() == Viscous(type="viscous", **dashpots)
    assert ViscoelasticInput(
        type="viscoelastic_input", wave_s="shake", **dashpots, **NEAR
    ).dashpots_alone() == ViscousInput(type="viscous_input", wave_s="shake", **dashpots)


@pytest.mark.parametrize(
    ("keys", "mistake"),
    [
        ({}, "exactly one of distance and source"),
        ({"distance": 1.0, "source": (0.0, 0.0)}, "exactly one of distance and source"),
        ({"distance": 0.0}, "greater than 0"),
        ({"distance": 1.0, "poisson_ratio": 0.2}, "poisson_ratio: needs young_modulus"),
        ({"distance": 1.0, "young_modulus": 1e9, "poisson_ratio": -1.0}, "greater than -1"),
        ({"distance": 1.0, "young_modulus": 1e9, "poisson_ratio": 0.51}, "less than or equal to 0.5"),
        ({"distance": 1.0, "alpha_s": -0.1}, "greater than or equal to 0"),
    ],
)
def test_springs_need_one_distance_and_a_possible_modulus(keys: dict[str, object], mistake: str) -> None:
    with pytest.raises(ValidationError, match=mistake):
        Viscoelastic(type="viscoelastic", **keys)


@pytest.mark.parametrize("kind", [Velocity, ViscousInput, ViscoelasticInput])
def test_a_driven_side_must_name_a_wave(kind: type[Velocity | ViscousInput | ViscoelasticInput]) -> None:
    name, springs = {
        Velocity: ("velocity", {}),
        ViscousInput: ("viscous_input", {}),
        ViscoelasticInput: ("viscoelastic_input", NEAR),
    }[kind]
    with pytest.raises(ValidationError, match="names no wave"):
        kind(type=name, **springs)


SHARES = np.array([0.5, 1.0])

INCOMING = {"wave_p": "push", "wave_s": "shake"}


@pytest.mark.parametrize("side", ["left", "top"])
@pytest.mark.parametrize(
    "table",
    [
        Viscous(type="viscous"),
        ViscousInput(type="viscous_input", **INCOMING),
        Viscoelastic(type="viscoelastic", distance=10.0),
        ViscoelasticInput(type="viscoelastic_input", distance=10.0, **INCOMING),
        FreeField(type="free_field"),
        Symmetry(type="symmetry"),
    ],
)
def test_a_particle_with_half_its_width_inside_has_half_of_all_forces(table: Boundary, side: str) -> None:
    whole, part = SupportBuilder(), SupportBuilder()
    edge = Edge(side, np.array([5, 6]), POSITIONS, DIAMETERS, 1.5)
    table.support(edge, MEDIUM, WAVES, whole)
    table.support(replace(edge, shares=SHARES), MEDIUM, WAVES, part)
    expected, found = whole.table(), part.table()

    share = SHARES[expected.node - 5]
    for name in ("damping", "follow", "stiffness"):
        np.testing.assert_allclose(getattr(found, name), share * getattr(expected, name), rtol=1e-15)
    np.testing.assert_allclose(found.drive, share[expected.drive_row] * expected.drive, rtol=1e-15)


def test_motion_that_is_prescribed_does_not_depend_on_widths() -> None:
    edge = Edge("left", np.array([5, 6]), POSITIONS, DIAMETERS, 1.5, SHARES)
    builder = SupportBuilder()
    Velocity(type="velocity", wave_p="shake").support(edge, MEDIUM, WAVES, builder)

    assert column(builder.table(), "push", 0).tolist() == [30.0, 30.0]


def test_p_waves_move_along_the_normal_and_s_waves_across() -> None:
    table = Velocity(type="velocity", wave_p="push", wave_s="shake")
    assert table.waves_by_axis(0) == ("push", "shake")
    assert table.waves_by_axis(1) == ("shake", "push")

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
    """Support rows by a boundary table for a side of two particles, 5 and 6."""
    builder = SupportBuilder()
    table.support(Edge(side, np.array([5, 6]), POSITIONS, DIAMETERS, 1.5), MEDIUM, WAVES, builder)
    return builder.table()


def column(supports: Supports, name: str, component: int) -> np.ndarray:
    """A column's values (2,) on one component of both particles."""
    values = supports.sample(np.array([TIME]), 0.0)[0] if name == "push" else getattr(supports, name)
    return values[supports.component == component]


G = 2000.0 * 500.0**2
"""ρc_s², Pa."""
BETAS = {"beta_p": 0.8, "beta_s": 0.4}
NEAR = {"alpha_n": 2.0, "alpha_s": 0.25, "distance": 40.0}
INCOMING = {"wave_p": "push", "wave_s": "shake"}
# Z eq. 4: C = βρcD; eq. 6: 2βρcD·v_i, along +x or +y whatever the side
NORMAL, ACROSS = {"damping": 0.8 * P}, {"damping": 0.4 * S}
# Z eq. 17: K = αGD/L; eq. 18: 2βρcD·v_i + KD·u_i with v_i = at and u_i = at²/2 at t = 3, a = 1 and 10
SPRINGS = np.outer([2.0, 0.25], G * DIAMETERS / 40.0)
HELD = {"prescribed": True}

RECIPES = [
    (Free(), {}),
    (Periodic(type="periodic"), {}),
    (Fixed(type="fixed"), {"normal": HELD, "across": HELD, "turn": HELD}),
    (Roller(type="roller"), {"normal": HELD}),
    (Velocity(type="velocity", wave_p="shake"), {"normal": HELD | {"push": 30.0}, "across": HELD}),
    (Viscous(type="viscous", **BETAS), {"normal": NORMAL, "across": ACROSS}),
    (
        # Z eq. 21: C = βρcD on v − v_ff
        FreeField(type="free_field", **BETAS),
        {"normal": NORMAL | {"follow": 0.8 * P}, "across": ACROSS | {"follow": 0.4 * S}},
    ),
    (
        ViscousInput(type="viscous_input", **BETAS, **INCOMING),
        {"normal": NORMAL | {"push": 2.0 * 0.8 * P * 3.0}, "across": ACROSS | {"push": 2.0 * 0.4 * S * 30.0}},
    ),
    (
        ViscousInput(type="viscous_input", wave_s="shake"),
        {"normal": {"damping": P}, "across": {"damping": S, "push": 2.0 * S * 30.0}},
    ),
    (
        # elongation 2u_n and bending 2θ on stiffnesses 7 and 3D; no dashpots
        Symmetry(type="symmetry"),
        {"normal": {"stiffness": 14.0}, "turn": {"stiffness": 6.0 * DIAMETERS}},
    ),
    (
        Viscoelastic(type="viscoelastic", **BETAS, **NEAR),
        {"normal": NORMAL | {"stiffness": SPRINGS[0]}, "across": ACROSS | {"stiffness": SPRINGS[1]}},
    ),
    (
        ViscoelasticInput(type="viscoelastic_input", **BETAS, **INCOMING, **NEAR),
        {
            "normal": NORMAL | {"stiffness": SPRINGS[0], "push": 2.0 * 0.8 * P * 3.0 + SPRINGS[0] * 4.5},
            "across": ACROSS | {"stiffness": SPRINGS[1], "push": 2.0 * 0.4 * S * 30.0 + SPRINGS[1] * 45.0},
        },
    ),
]


@pytest.mark.parametrize(("side", "normal"), [("left", 0), ("right", 0), ("bottom", 1), ("top", 1)])
@pytest.mark.parametrize(("table", "expected"), RECIPES, ids=lambda given: getattr(given, "type", ""))
def test_each_type_fills_the_rows_of_its_formula_and_nothing_else(table, expected, side: str, normal: int) -> None:
    supports = rows(table, side)
    axes = {"normal": normal, "across": 1 - normal, "turn": 2}

    assert len(supports) == 2 * len(expected)
    for way, values in expected.items():
        assert sorted(supports.node[supports.component == axes[way]]) == [5, 6]
        for name in ("damping", "stiffness", "push", "prescribed", "follow"):
            # products of the same factors in another order differ by rounding
            found = column(supports, name, axes[way])
            np.testing.assert_allclose(found, np.broadcast_to(values.get(name, 0.0), 2), rtol=1e-15, err_msg=name)


def test_at_a_corner_only_the_free_fields_share_follows_and_nothing_where_it_is_fixed() -> None:
    def both(other: Boundary) -> Supports:
        builder = SupportBuilder()
        for table in (FreeField(type="free_field", **BETAS), other):
            table.support(Edge("left", np.array([5, 6]), POSITIONS, DIAMETERS, 1.5), MEDIUM, WAVES, builder)
        return builder.table()

    supports = both(Viscous(type="viscous"))
    np.testing.assert_allclose(column(supports, "damping", 0), 1.8 * P, rtol=1e-15)
    np.testing.assert_allclose(column(supports, "follow", 0), 0.8 * P, rtol=1e-15)
    supports = both(Fixed(type="fixed"))
    assert supports.prescribed.all()
    assert not supports.follow.any()
    assert not supports.damping.any()


SHARES = np.array([0.5, 1.0])


@pytest.mark.parametrize(
    "table",
    [table for table, rows in RECIPES if rows and table.type not in ("fixed", "roller")],
    ids=lambda table: table.type,
)
def test_a_particle_with_half_its_width_inside_has_half_of_all_forces(table: Boundary) -> None:
    whole, part = SupportBuilder(), SupportBuilder()
    edge = Edge("left", np.array([5, 6]), POSITIONS, DIAMETERS, 1.5)
    table.support(edge, MEDIUM, WAVES, whole)
    table.support(replace(edge, shares=SHARES), MEDIUM, WAVES, part)
    expected, found = whole.table(), part.table()

    share = np.where(expected.prescribed, 1.0, SHARES[expected.node - 5])  # prescribed motion does not depend on widths
    for name in ("damping", "follow", "stiffness"):
        np.testing.assert_allclose(getattr(found, name), share * getattr(expected, name), rtol=1e-15)
    np.testing.assert_allclose(found.drive, share[expected.drive_row] * expected.drive, rtol=1e-15)


@pytest.mark.parametrize(
    "table",
    [
        ViscousInput(type="viscous_input", wave_p="push", beta_s="matched"),
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


def test_springs_take_the_modulus_given_and_weaken_with_the_distance_from_the_source() -> None:
    for given, modulus in (({}, 6e8), ({"poisson_ratio": 0.25}, 4.8e8)):
        supports = rows(Viscoelastic(type="viscoelastic", young_modulus=1.2e9, distance=40.0, **given), "left")
        # G = E/(2(1 + ν)), α_n = 1 and α_s = 0.5 by default
        np.testing.assert_allclose(column(supports, "stiffness", 0), modulus * DIAMETERS / 40.0, rtol=1e-15)
        np.testing.assert_allclose(column(supports, "stiffness", 1), modulus * DIAMETERS / 80.0, rtol=1e-15)
    supports = rows(Viscoelastic(type="viscoelastic", source=(3.25, 8.0)), "left")
    distances = np.array([5.0, np.sqrt(32.5625)])  # 3-4-5 triangle, and hypot(2.75, 5)
    np.testing.assert_allclose(column(supports, "stiffness", 0), G * DIAMETERS / distances, rtol=1e-15)


def test_a_source_within_a_particle_of_the_side_is_refused() -> None:
    # the second particle's surface is 0.5 m from its centre
    with pytest.raises(CaseError, match=r"^boundary\.left\.source: lies in a particle"):
        rows(Viscoelastic(type="viscoelastic", source=(0.5, 3.49)), "left")
    assert len(rows(Viscoelastic(type="viscoelastic", source=(0.5, 2.49)), "left")) == 4


def test_a_side_without_its_springs_or_column_is_viscous() -> None:
    dashpots = {"beta_p": 0.8, "beta_s": 0.4, "half_mass": True}

    assert Viscoelastic(type="viscoelastic", **dashpots, **NEAR).dashpots_alone() == Viscous(type="viscous", **dashpots)
    assert ViscoelasticInput(
        type="viscoelastic_input", wave_s="shake", **dashpots, **NEAR
    ).dashpots_alone() == ViscousInput(type="viscous_input", wave_s="shake", **dashpots)
    assert FreeField(type="free_field", **BETAS).dashpots_alone() == Viscous(type="viscous", **BETAS)
    assert not FreeField(type="free_field").half_mass


@pytest.mark.parametrize(
    ("kind", "keys", "mistake"),
    [
        (Viscoelastic, {}, "exactly one of distance and source"),
        (Viscoelastic, {"distance": 1.0, "poisson_ratio": 0.2}, "poisson_ratio: needs young_modulus"),
        (Viscoelastic, {"distance": 1.0, "young_modulus": 1e9, "poisson_ratio": 0.51}, "less than or equal to 0.5"),
        (ViscousInput, {}, "names no wave"),
        (FreeField, {"half_mass": True}, "half_mass: is not allowed on a free-field side"),
    ],
)
def test_impossible_sides_are_refused(kind: type[Boundary], keys: dict[str, object], mistake: str) -> None:
    with pytest.raises(ValidationError, match=mistake):
        kind(type=kind.model_fields["type"].annotation.__args__[0], **keys)


def test_p_waves_move_along_the_normal_and_s_waves_across() -> None:
    table = Velocity(type="velocity", wave_p="push", wave_s="shake")
    assert table.waves_by_axis(0) == ("push", "shake")
    assert table.waves_by_axis(1) == ("shake", "push")

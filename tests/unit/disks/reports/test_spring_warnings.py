"""Springs of sides that are not those of the ground beyond."""

import pytest
from small_cases import small

from dembound.disks.reports.spring_warnings import spring_warnings
from dembound.disks.scene import build

GROUND = {
    "packing": {"pattern": "A", "size": [20.0, 10.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {"bottom": {"type": "viscoelastic", "distance": 10.0}},
    "wave": {"blow": {"type": "cosine", "amplitude": 1.0, "period": 0.05}},
    "run": {"duration": 0.01},
}
BLOW = {"name": "blow", "force": [0.0, -1e5], "position": [9.5, 9.5], "wave": "blow"}
PRESS = {"name": "press", "pressure": 1e5, "hole": "cavity", "wave": "blow"}
CAVITY = {"name": "cavity", "type": "circle", "centre": [10.0, 5.0], "radius": 2.0}
DRIVEN = {"top": {"type": "viscous_input", "wave_p": "blow"}}


def said(side: dict, **tables: object) -> list[str]:
    sides = {"boundary": {"bottom": {"type": "viscoelastic", **side}, **tables.pop("boundary", {})}}
    return list(spring_warnings(build(small(GROUND, changes={**sides, **tables}))))


@pytest.mark.parametrize(
    ("source", "wrong"),
    [([10.0, 10.0], False), ([8.0, 9.0], False), ([36e3, 10.0], True), ([10.0, -2.0], True), ([10.0, 40.0], True)],
)
def test_a_source_that_is_no_centre_of_the_waves_is_warned_of(source: list, wrong: bool) -> None:
    """The load is 9 m above the row of the side; from −2 m springs are twice as stiff in the mean of 1/L."""
    found = said({"source": source}, load=[BLOW])
    assert len(found) == wrong
    assert not wrong or "but waves come from load.blow, at (9.5, 9.5) m" in found[0]


def test_a_cavity_is_a_centre_of_waves() -> None:
    assert said({"source": [10.0, 5.0]}, load=[PRESS], hole=[CAVITY]) == []
    (found,) = said({"source": [10.0, 500.0]}, load=[PRESS], hole=[CAVITY])
    assert "waves come from" in found


@pytest.mark.parametrize(("source", "wrong"), [([10.0, 100.0], False), ([10.0, -36e3], True)])
def test_without_a_centre_a_source_may_be_anywhere_near(source: list, wrong: bool) -> None:
    found = said({"source": source}, boundary=DRIVEN)
    assert len(found) == wrong
    assert not wrong or "times its diagonal" in found[0]


@pytest.mark.parametrize(("modulus", "wrong"), [(2.0e9, False), (2.0e6, True), (2.0e12, True)])
def test_springs_of_another_modulus_are_warned_of(modulus: float, wrong: bool) -> None:
    """The disks have G = ρc_s² = 1.25 GPa, with c_s = c_p/√2 or c_p/2 of 625 MPa."""
    found = said({"distance": 10.0, "young_modulus": modulus}, load=[BLOW])
    assert len(found) == wrong
    assert not wrong or "young_modulus: gives springs of G = 1e+" in found[0]


@pytest.mark.parametrize(("distance", "wrong"), [(220.0, False), (230.0, True)])
def test_a_distance_far_beyond_the_scene_is_warned_of(distance: float, wrong: bool) -> None:
    """Ten diagonals of 20 × 10 m are 223.6 m."""
    found = said({"distance": distance}, load=[BLOW])
    assert len(found) == wrong
    assert not wrong or "boundary.bottom.distance: is 230 m, 10.3 times" in found[0]


def test_springs_without_stiffness_are_warned_of() -> None:
    (found,) = said({"distance": 10.0, "alpha_n": 0.0, "alpha_s": 0.0})
    assert found.startswith("boundary.bottom: alpha_n and alpha_s are 0, so it has no springs")
    assert said({"distance": 10.0, "alpha_n": 0.0}) == []

"""What a case of disks would come to."""

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.kind import Disks
from dembound.disks.reports.facts import disk_facts
from dembound.running import plan, warnings_before

SLOW = {"wave.pulse.period": 0.5, "run.duration": 0.5}
"""A wave far longer than the bar, nothing about which is to be warned of."""


def facts_of(case: Case) -> dict[str, str]:
    return dict(disk_facts(Disks().build(case)))


def test_facts_are_those_of_the_scene(bar) -> None:
    facts = facts_of(bar({"boundary.right.beta_p": 0.9}))

    assert facts["particles"] == "40"
    assert facts["contacts"] == "58"
    assert "c_p = 1000.0 m/s" in facts["wave speeds"]
    assert "c_s" not in facts["wave speeds"]  # y is held
    assert facts["right side"].startswith("viscous, β_P = 0.9 (matched: 1), β_S = 1; 2 particles")
    assert facts["top side"].startswith("free; 20 particles")
    # the disk nearest to (5, 0.5) is one of four at the same distance
    assert facts["monitor middle"].split(" at ")[1] in {
        f"({x}, {y}) m" for x in ("4.750", "5.250") for y in ("0.250", "0.750")
    }


def test_a_side_says_that_its_masses_are_halved(bar) -> None:
    facts = facts_of(bar({"boundary.right.half_mass": True}))

    assert facts["right side"].startswith("viscous, β_P = 1 (matched), β_S = 1, half mass; 2 particles")


def test_a_periodic_side_is_no_side(bar) -> None:
    facts = facts_of(bar({"boundary.bottom": {"type": "periodic"}, "boundary.top": {"type": "periodic"}}))

    assert "left side" in facts
    assert "top side" not in facts


def test_waves_of_loads_have_no_stress(bar) -> None:
    tap = {"name": "tap", "force": [1.0, 0.0], "position": [5.0, 0.5], "wave": "tapping"}
    hammer = {"load": [tap], "wave.tapping": {"type": "cosine", "amplitude": 1e6, "period": 1.0}}
    case = bar({**hammer, "material.law": "linearpbond", **SLOW})
    facts = facts_of(case)

    assert "stress of pulse" in facts
    assert "stress of tapping" not in facts
    assert warnings_before(plan(case)) == []


WEIGHT = {
    "static": {"boundary": {"left": {"type": "fixed"}}},
    "load": [{"name": "weight", "acceleration": [1.0, 0.0]}],
}


@pytest.mark.parametrize(
    ("changes", "pressure"),
    [
        ({}, "0"),  # a lattice is packed without stress
        ({"static": {"stress": [-3e5, -1e5, 7e5]}}, "0.2"),
        ({"static": {"stress": [0.0, 0.0, 0.0]}}, "0"),
        ({"static": {"stress": [-3e6, -3e6, 0.0]}}, None),
        (WEIGHT, None),  # what the stage leaves cannot be known before
        ({"material.elastic_start": False}, None),
    ],
)
def test_with_a_memory_a_strong_wave_is_no_warning_but_where_the_law_changes(bar, changes, pressure) -> None:
    case = bar({"material.law": "linearpbond", **SLOW, **changes})
    facts = facts_of(case)

    assert [line for line in warnings_before(plan(case)) if not line.startswith("static: the steady")] == []
    if pressure is None:
        assert "stress of pulse" not in facts
    else:  # 2500·1000·0.5 Pa
        assert facts["stress of pulse"] == (
            f"ρcv = 1.25 MPa, above the confining stress of {pressure} MPa; "
            "in tension contacts open, and the law changes to linearpbond"
        )


@pytest.mark.parametrize(
    ("material", "law", "strength"),
    [
        ({}, "elastic: contacts neither open nor slip, bonds do not break", None),
        (
            {"law": "linearpbond", "pb_coh": 2e6, "pb_fa": 30.0, "fric": 0.5},
            "linearpbond, elastic until a contact opens, slips or closes or a bond yields",
            "bonds unbreakable in tension, 2 MPa + σ·tan 30° in shear; contacts slip at 0.5 of their normal force",
        ),
        (
            {"law": "linearpbond", "pb_ten": 1.5e6, "elastic_start": False},
            "linearpbond",
            "bonds 1.5 MPa in tension, unbreakable in shear; contacts slip at 0 of their normal force",
        ),
        (
            {"law": "linearpbond", "contact_share": 1.0, "fric": 0.5},
            "linearpbond, elastic until a contact opens, slips or closes or a bond yields",
            "no bonds; contacts slip at 0.5 of their normal force",
        ),
    ],
)
def test_the_law_is_told_with_its_strength(bar, material, law, strength) -> None:
    case = bar({f"material.{key}": value for key, value in material.items()})
    facts = facts_of(case)

    assert facts["law"] == law
    assert facts.get("strength") == strength
    assert ("once it begins" in "".join(Disks().not_estimated(case))) == ("elastic until" in law)


@pytest.mark.parametrize(
    ("material", "share"),
    [
        ({}, "50"),
        ({"contact_share": 0.3, "fric": 0.5}, "70"),
        ({"contact_share": 1.0, "fric": 0.5}, "0"),
        ({"contact_share": 0.0}, None),  # no contact opens
        ({"law": "elastic"}, None),  # nor under that law
    ],
)
def test_tension_meets_the_bonds_share_of_the_stiffness(bar, material: dict, share: str | None) -> None:
    facts = facts_of(bar({f"material.{key}": value for key, value in {"law": "linearpbond", **material}.items()}))

    if share is None:
        assert "tension" not in facts
    else:
        assert facts["tension"].startswith(f"in tension the stiffness falls to {share} %, as contacts open")


PACKED = {
    "packing": {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]},
    "monitor": [],
    "static": {},
    "material.law": "linearpbond",
}


@pytest.mark.parametrize(
    ("material", "stress"),
    [
        ({"locked_in": 2.5e6}, "2.5 MPa before the static stage"),
        ({"locked_in": 2.5e6, "pb_ten": 4e6}, "2.5 MPa before the static stage, 62.5 % of pb_ten"),
        (
            {"locked_in": 2.5e6, "pb_ten": 4e6, "pb_coh": 1e7},
            "2.5 MPa before the static stage, 62.5 % of pb_ten, 25 % of pb_coh",
        ),
        ({"locked_in": 2.5e6, "pb_coh": 2e6}, "2.5 MPa before the static stage, 125 % of pb_coh"),
        ({"pb_ten": 4e6}, None),
    ],
)
def test_a_locked_in_stress_stands_beside_the_strength(bar, material: dict, stress: str | None) -> None:
    static = {} if "locked_in" in material else {"static": {"stress": [-1e6, -1e6, 0.0]}}
    facts = facts_of(bar({**PACKED, **static, **{f"material.{key}": value for key, value in material.items()}}))

    assert facts.get("locked-in stress") == stress


def test_loads_and_the_static_stage_are_told(bar) -> None:
    weight = {"name": "weight", "acceleration": [10.0, 0.0]}
    tap = {"name": "tap", "force": [1e6, 0.0], "region": [0.0, 0.0, 1.0, 1.0], "wave": "pulse"}
    static = {"stress": [-1e6, -2e6, 0.0], "boundary": {"left": {"type": "fixed"}}}
    case = bar({"load": [weight, tap], "static": static})
    facts = facts_of(case)

    # 40 disks of 625 kg; two of them in each of two columns in the region
    assert facts["load weight"] == "(2.5e+05, 0) N/m on 40 particles, steady"
    assert facts["load tap"] == "(1e+06, 0) N/m on 4 particles, times wave pulse"
    assert facts["static stage"] == "under weight and σ_xx, σ_yy, σ_xy = -1, -2, 0 MPa, to a force ratio of 1e-05"
    assert facts["static sides"] == "left fixed"
    assert Disks().not_estimated(case) == ["the static stage"]


def test_holes_are_told_with_what_they_leave(bar) -> None:
    niche = {"name": "niche", "type": "rectangle", "corners": [6.0, 0.5, 8.0, 1.1]}
    gap = {"name": "gap", "type": "rectangle", "corners": [8.9, 0.5, 9.4, 1.1], "stage": "after"}
    tables = {"static": {"stress": [0.0, 0.0, 0.0]}, "monitor": []}
    facts = facts_of(bar({**tables, "hole": [niche]}))

    assert facts["particles"] == "36"
    assert facts["hole niche"] == "rectangle, present from the start"
    facts = facts_of(bar({**tables, "hole": [niche, gap]}))
    assert facts["particles"] == "35, 36 before the excavation"
    assert facts["hole gap"] == "rectangle, excavated once the body has settled"


def test_severed_particles_are_told(bar) -> None:
    outer, inner = [[3, 1], [6, 1], [6, 4], [3, 4], [3, 1]], [[4, 2], [4, 3], [5, 3], [5, 2], [4, 2]]
    moat = {"name": "moat", "type": "polygon", "points": [*outer, *inner]}
    facts = facts_of(bar({"packing.size": [10.0, 5.0], "hole": [moat]}))

    # 36 disks of the outer square go, four of which are an island
    assert facts["particles"] == "164; 4 severed disks left out"


SPRINGS = {"alpha_n": 2.0, "young_modulus": 2e9}


def test_springs_of_a_side_are_told(bar) -> None:
    far = {"type": "viscoelastic", "distance": 40.0, **SPRINGS}
    near = {"type": "viscoelastic", "source": [5.0, 10.0], **SPRINGS}
    facts = facts_of(bar({"boundary.right": far, "boundary.bottom": near}))

    assert "; springs α_n = 2, α_s = 0.5, G = 1 GPa, L = 40 m; 2 particles" in facts["right side"]
    # the bottom row lies 9.75 m below the source, its disks at 0.25 m to 4.75 m beside it
    assert f"L = {np.hypot(0.25, 9.75):.4g}…{np.hypot(4.75, 9.75):.4g} m; 20 particles" in facts["bottom side"]

"""Facts about a case of disks."""

import re

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.kinds.disks.facts import disk_facts
from dembound.kinds.disks.kind import Disks
from dembound.running import plan, warnings_before

SLOW = {"wave.pulse.period": 0.5, "run.duration": 0.5}
"""A wave far longer than the bar, without warnings."""


def facts_of(case: Case) -> dict[str, str]:
    return dict(disk_facts(Disks().build(case)))


def test_facts_are_those_of_the_scene(bar) -> None:
    springs = {"alpha_n": 2.0, "young_modulus": 2e9}
    near = {"type": "viscoelastic", "source": [5.0, 10.0], **springs}
    facts = facts_of(bar({"boundary.right.beta_p": 0.9, "boundary.right.half_mass": True, "boundary.bottom": near}))

    assert "c_p = 1000 m/s" in facts["wave speeds"]
    assert "c_s" not in facts["wave speeds"]  # y is held
    assert facts["right side"].startswith("viscous, β_P = 0.9 (matched: 1), β_S = 1, half mass; 2 particles")
    assert facts["top side"].startswith("free; 20 particles")
    # the bottom row lies 9.75 m below the source, its disks at 0.25 m to 4.75 m beside it
    assert f"L = {np.hypot(0.25, 9.75):.4g}…{np.hypot(4.75, 9.75):.4g} m; 20 particles" in facts["bottom side"]
    # 20 disks of 0.5 m in the slowest wave, of 500 m/s
    assert facts["wave pulse"].endswith(" shortest wavelength, at 327 Hz; disks carry waves up to 50 Hz")


def test_what_whole_cells_return_is_said_where_half_cells_are_possible(bar) -> None:
    """A wave of mean frequency f returns πfD/2c of this P wave; S waves are held."""
    long = {"wave.pulse.period": 0.02}
    said = re.search(r"cells return (.*) % of P waves at (.*) Hz", facts_of(bar(long))["right side"])
    assert said is not None
    share, frequency = map(float, said.groups())
    assert share == pytest.approx(100.0 * np.pi * frequency * 0.5 / 2000.0, rel=0.02)  # of two digits
    for changes in ({"boundary.right.half_mass": True}, {"boundary.right.beta_p": 0.5}, SLOW):
        assert "whole cells" not in facts_of(bar(long | changes))["right side"]


@pytest.mark.parametrize(
    ("changes", "pressure"),
    [
        ({}, "0 Pa"),  # a lattice is packed without stress
        ({"static": {"stress": [-3e5, -1e5, 7e5]}}, "200 kPa"),
        ({"static": {"stress": [-3e6, -3e6, 0.0]}}, None),
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
            f"ρcv = 1.25 MPa, above the confining stress of {pressure}; "
            "in tension contacts open, and the law changes to linearpbond"
        )


UNTIL = "linearpbond, elastic until a contact opens, slips or closes or a bond yields"
SLIP = "contacts slip at 0.5 of their normal force"


@pytest.mark.parametrize(
    ("material", "law", "strength", "share"),
    [
        (
            {"pb_coh": 2e6, "pb_fa": 30.0, "fric": 0.5, "contact_share": 0.3},
            UNTIL,
            f"bonds unbreakable in tension, 2 MPa + σ·tan 30° in shear; {SLIP}",
            "70",
        ),
        ({"contact_share": 1.0, "fric": 0.5}, UNTIL, f"no bonds; {SLIP}", "0"),
    ],
)
def test_the_law_is_reported_with_strength_and_stiffness_in_tension(bar, material, law, strength, share) -> None:
    case = bar({f"material.{key}": value for key, value in {"law": "linearpbond", **material}.items()})
    facts = facts_of(case)

    assert (facts["law"], facts.get("strength")) == (law, strength)
    assert ("once it begins" in "".join(Disks().not_estimated(case))) == ("elastic until" in law)
    assert ("tension" in facts) == (share is not None)
    assert share is None or facts["tension"].startswith(
        f"in tension the stiffness falls to {share} %, as contacts open"
    )


def test_loads_and_the_static_stage_are_reported(bar) -> None:
    weight = {"name": "weight", "acceleration": [10.0, 0.0]}
    tap = {"name": "tap", "force": [1e6, 0.0], "region": [0.0, 0.0, 1.0, 1.0], "wave": "pulse"}
    static = {"stress": [-1e6, -2e6, 0.0], "boundary": {"left": {"type": "fixed"}}}
    case = bar({"load": [weight, tap], "static": static})
    facts = facts_of(case)

    # 40 disks of 625 kg; two of them in each of two columns in the region
    assert facts["load weight"] == "(250, 0) kN/m on 40 particles, steady"
    assert facts["load tap"] == "(1, 0) MN/m on 4 particles, times wave pulse"
    assert (
        facts["static stage"]
        == "under weight and σ_xx, σ_yy, σ_xy = -1, -2, 0 MPa, to an unbalanced force ratio of 1e-05"
    )
    assert facts["static sides"] == "left fixed"
    own = facts_of(bar({"static": static, "material.law": "linearpbond"}))["static stage"]
    assert own.endswith("ratio of 1e-05, of 1e-07 once contacts slide or open")
    assert Disks().not_estimated(case) == []
    assert Disks().settles(case)

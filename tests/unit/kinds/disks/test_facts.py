"""Facts about a case of disks."""

import re

import numpy as np
import pytest
from disk_systems import LAMB
from scene_tables import point
from small_cases import SURROUNDED, around, small

from dembound.casefile import Case
from dembound.disks.material.packing_waves import sent_back
from dembound.disks.scene import build
from dembound.disks.surroundings.settings import signals_of
from dembound.formulas.disks.continuum import expected_errors
from dembound.kinds import with_changes
from dembound.kinds.disks.continuum_facts import continuum_facts, continuum_warnings
from dembound.kinds.disks.facts import disk_facts
from dembound.kinds.disks.incident_wave import incident_facts
from dembound.kinds.disks.kind import Disks
from dembound.words import percent

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
    ("material", "strength", "share"),
    [
        (
            {"pb_coh": 2e6, "pb_fa": 30.0, "contact_share": 0.3},
            "bonds unbreakable in tension, 2 MPa + σ·tan 30° in shear",
            "70",
        ),
        ({"contact_share": 1.0}, "no bonds", "0"),
    ],
)
def test_the_law_is_reported_with_strength_and_stiffness_in_tension(bar, material, strength, share) -> None:
    law = {"law": "linearpbond", "fric": 0.5, **material}
    case = bar({f"material.{key}": value for key, value in law.items()})
    facts = facts_of(case)
    assert facts["law"] == "linearpbond, elastic until a contact opens, slips or closes or a bond yields"
    assert facts["strength"] == f"{strength}; contacts slip at 0.5 of their normal force"
    slower = Disks().slower(build(case))
    assert slower is not None
    assert slower.words == ("all broken" if "pb_coh" in material else "all loose")
    assert slower.then > slower.first
    assert facts["tension"].startswith(f"in tension the stiffness falls to {share} %, as contacts open")


def test_loads_and_the_static_stage_are_reported(bar) -> None:
    weight = {"name": "weight", "acceleration": [10.0, 0.0]}
    tap = {"name": "tap", "force": [1e6, 0.0], "region": [0.0, 0.0, 1.0, 1.0], "wave": "pulse"}
    static = {"stress": [-1e6, -2e6, 0.0], "boundary": {"left": {"type": "fixed"}}}
    case = bar({"load": [weight, tap], "static": static})
    facts = facts_of(case)

    # 40 disks of 625 kg; two of them in each of two columns in the region
    assert facts["load weight"] == "(250, 0) kN/m on 40 particles, steady"
    assert facts["load tap"] == "(1, 0) MN/m on 4 particles, times wave pulse"
    stage = "under weight and σ_xx, σ_yy, σ_xy = -1, -2, 0 MPa, to an unbalanced force ratio of 1e-05"
    assert facts["static stage"] == stage
    assert facts["static sides"] == "left fixed"
    own = facts_of(bar({"static": static, "material.law": "linearpbond"}))["static stage"]
    assert own.endswith("ratio of 1e-05, of 1e-07 once contacts slide or open")
    assert Disks().slower(build(case)) is None
    assert Disks().settles(case)


BESIDE = {"name": "beside", "position": [-1.5, 3.5]}
CASE = SURROUNDED | {
    "incident": {"type": "sv", "angle": 30.0, "wave": "pulse"},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.05, "start": 0.01}},
    "monitor": [*SURROUNDED["monitor"], BESIDE],
}


def test_facts_of_the_waves() -> None:
    """s_x = sin 30°/c_s = 1/1414 s/m, |A| as at a free surface; at the first disk, (0.5, 0.5) m, 0.97 ms later."""
    facts = dict(incident_facts(build(small(CASE))))

    assert facts["incident wave"].startswith("SV, 30° from the vertical to the right, with the velocity of wave pulse")
    assert "at (0, 0) m, at 1414.2 m/s along the surface; reaches the disks at 0.01097 s" in facts["incident wave"]
    expected = "SV at 30° with 0.268 of the amplitude; P at 45° with 0.897 of the amplitude; critical from 45° on"
    assert facts["reflected waves"] == expected
    assert facts["less exact monitors"] == "near the corners where layers begin: (-3, -3), (15, -3) m"


STAYS = {"type": "constant", "amplitude": 1.0, "rise": 0.4}
RANDOM = {"pattern": "B", "size": [40.0, 20.0], "radius": 0.5, "radius_ratio": 1.5, "brick": [10.0, 10.0], "seed": 1}


@pytest.fixture
def case(bar):
    """A case with c_p = 1000 m/s, c_s = 707 m/s."""
    return bar(LAMB | {"material.fric": 0.5, "run.duration": 10.0})


def facts_beyond(case, **changes) -> dict[str, str]:
    return dict(continuum_facts(build(with_changes(case, changes))))


def warnings_of(case, **changes) -> list[str]:
    return list(continuum_warnings(build(with_changes(case, changes)), 1000.0))


def test_facts_are_those_of_the_continuum(case) -> None:
    facts = facts_beyond(case, **{"outside.element": 10.0})

    # 12 × 6 elements less 4 × 2; (4·12 + 1) × (4·6 + 1) nodes less 15 × 8 inside the box, whose top is the surface
    assert facts["continuum"] == (
        "1,105 nodes in 64 elements of order 4, 10 m × 10 m, 84 % of which absorb; joined to disks at 80 places"
    )
    # 2.625/T; 707.1/13.1 m
    assert facts["continuum waves"].startswith("21.5 nodes in the shortest wavelength, 53.9 m (0.1 % of the energy ")
    assert facts["absorbing layers"].startswith(
        "begin 10 m beyond the sides and are 30 m deep, 3 elements, and keep 0.01 % of P waves"
    )
    assert "elements themselves about 0.04 %" in facts["absorbing layers"]


def test_copies_of_a_random_brick_are_said_to_send_waves_back(case) -> None:
    """Bricks of 10 m do so from 36 Hz on, as do forces along both axes and waves from below along y."""
    short = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
    below = around("outside") | {"bottom": {"type": "outside", "wave_s": "pulse"}}
    of_forces = with_changes(case, {"packing": RANDOM, "wave": {"pulse": short}})
    for changed, axes in ((of_forces, (0, 1)), (with_changes(of_forces, {"load": [], "boundary": below}), (1,))):
        scene = build(changed)
        share = percent(sent_back(scene.ground, signals_of(changed), (40.0, 20.0), axes).share)
        fact = dict(continuum_facts(scene))["copies of the brick"]
        assert fact.startswith(f"send back up to {share} of the velocity")
        assert fact.endswith("shorter bricks send back less")

    slow = facts_beyond(case, packing=RANDOM)  # 13 Hz
    assert "copies of the brick" not in slow
    assert "above outside.accuracy, as elements smaller than 11.2 m shorten the time step" in slow["continuum waves"]
    assert "copies of the brick" not in facts_beyond(case, wave={"pulse": short})  # a lattice


STRONG = "outside.reflection: is 0.01, above outside.accuracy = 0.1 %; give at most 0.0001"
SMALL = "outside.element: elements of 4 m shorten the time step, and below 5 m nothing is gained"
MISSING = "outside.margin: under a load that stays for 10 s about 0.31 % of the displacement will be missing, more "
LASTING = {"wave": {"pulse": STAYS}, "outside.margin": 1}


@pytest.mark.parametrize(
    ("changes", "start"),
    [
        ({"outside.element": 20.0}, "outside.element: elements of 20 m return short waves, about 0.8"),
        ({"outside.layers": 2}, "outside.layers: 2 elements of order 4 return about 0.7 % of the displacement"),
        ({"outside.reflection": 0.01}, STRONG),
        ({"outside.element": 4.0}, SMALL),
        (LASTING, f"{MISSING}than outside.accuracy = 0.1 %; 300 m within the layers are enough, now 120 m"),
    ],
)
def test_poor_settings_have_one_line_each(case, changes: dict, start: str) -> None:
    (line,) = warnings_of(case, **changes)
    assert line.startswith(start)
    assert ("of the velocity of all that meets them" in line) == ("return short waves" in line)  # not at monitors
    assert warnings_of(case, **changes, **{"outside.accuracy": 0.05}) == [line] * ("below 5 m" in line)
    assert warnings_of(case, **{key: value for key, value in changes.items() if key == "wave"}) == []


def test_a_margin_too_small_below_the_surface(case) -> None:
    deep = {"ground.size": [100.0, 150.0], "packing.origin": [30.0, 0.0], "load": [point((0.0, -1e6), (50.5, 9.5))]}
    deep["boundary"] = around("outside", "left", "right", "bottom", "top")
    assert warnings_of(case, **deep) == []
    (line,) = warnings_of(case, **deep, **{"outside.element": 5.0, "outside.margin": 2})
    start = "outside.margin: waves that the free surface sends back run along layers 10 m beside the disks, and about "
    assert line.startswith(start)
    assert line.endswith(" elements are enough")


def test_layers_of_strongly_anisotropic_ground(case) -> None:
    """They return more, which is said, and no formula says how much; one lattice below others is enough."""
    shear = {"material.kratio": 0.1, "material.pb_kratio": 0.1}
    assert (
        ", 3 elements, and keep 0.01 % of P waves there and back; they stretch both axes, "
        in facts_beyond(case, **shear)["absorbing layers"]
    )
    (line,) = warnings_of(case, **shear)
    assert "those it needs return up to about 3 % of the motion, more than outside.accuracy = 0.1 %, and" in line
    assert warnings_of(case, **shear, **{"outside.accuracy": 0.04}) == []
    assert expected_errors(build(with_changes(case, shear)), {"here": np.array([20.0, 10.0])}) is None

"""The continuum round a body in words, and warnings about its settings."""

import re

import numpy as np
import pytest
from disk_systems import LAMB

from dembound.disks.material.packing_waves import sent_back
from dembound.disks.scene import build
from dembound.disks.surroundings.settings import signals_of
from dembound.formulas.disks.continuum import expected_errors
from dembound.kinds import with_changes
from dembound.kinds.disks.continuum_facts import ANGLES, continuum_facts, continuum_warnings
from dembound.words import percent

STAYS = {"type": "constant", "amplitude": 1.0, "rise": 0.4}
RANDOM = {"pattern": "B", "size": [40.0, 20.0], "radius": 0.5, "radius_ratio": 1.5, "brick": [10.0, 10.0], "seed": 1}


@pytest.fixture
def case(bar):
    """A case with c_p = 1000 m/s, c_s = 707 m/s."""
    return bar(LAMB | {"material.fric": 0.5, "run.duration": 10.0})


def facts_of(case, **changes) -> dict[str, str]:
    return dict(continuum_facts(build(with_changes(case, changes))))


def warnings_of(case, **changes) -> list[str]:
    return list(continuum_warnings(build(with_changes(case, changes)), 1000.0))


def test_facts_are_those_of_the_scene(case) -> None:
    facts = facts_of(case, **{"outside.element": 10.0})

    # 12 × 6 elements less 4 × 2; (4·12 + 1) × (4·6 + 1) nodes less 15 × 8 inside the box, whose top is the surface
    assert facts["continuum"] == ("1,105 nodes in 64 elements of order 4, 10 m × 10 m, 84 % of which absorb; 80 ties")
    # 2.625/T; 707.1/13.1 m
    assert facts["continuum waves"].startswith("21.5 nodes in the shortest wavelength, 53.9 m (0.1 % of the energy ")
    assert facts["absorbing layers"].startswith(
        "begin 10 m beyond the sides and are 30 m deep, 3 elements, R0 = 0.0001"
    )
    assert "elements themselves about 0.04 %" in facts["absorbing layers"]


def test_reflections_are_those_of_the_profile(case) -> None:
    """R0^(cos θ c_p/c), as α is small beside ω: 1e-4, 1e-2 at 60°, and its 1.414th power of S waves."""
    words = facts_of(case)["absorbing layers"]
    p, s = re.search(r"at most ([\d., e-]+) % of P and ([\d., e-]+) % of S", words).groups()

    for found, slower in ((p, 1.0), (s, np.sqrt(2.0))):
        expected = 100.0 * 1e-4 ** (np.cos(np.radians(ANGLES)) * slower)
        assert [float(each) for each in found.split(",")] == pytest.approx(expected, rel=0.05)


def test_copies_of_a_random_brick_are_said_to_send_waves_back(case) -> None:
    """Bricks of 10 m do so from 36 Hz on, as do forces along both axes and waves from below along y."""
    short = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
    below = {side: {"type": "outside"} for side in ("left", "right")}
    below["bottom"] = {"type": "outside", "wave_s": "pulse"}
    of_forces = with_changes(case, {"packing": RANDOM, "wave": {"pulse": short}})
    for changed, axes in ((of_forces, (0, 1)), (with_changes(of_forces, {"load": [], "boundary": below}), (1,))):
        scene = build(changed)
        share = percent(sent_back(scene.ground, signals_of(changed), (40.0, 20.0), axes).share)
        fact = dict(continuum_facts(scene))["copies of the brick"]
        assert fact.startswith(f"send back up to {share} of the velocity")
        assert fact.endswith("shorter bricks send back less")

    slow = facts_of(case, packing=RANDOM)  # 13 Hz
    assert "copies of the brick" not in slow
    assert "above outside.accuracy, as elements smaller than 11.2 m shorten the time step" in slow["continuum waves"]
    assert "copies of the brick" not in facts_of(case, wave={"pulse": short})  # a lattice


STRONG = "outside.reflection: is 0.01, above outside.accuracy = 0.1 %; give at most 0.0001"
SMALL = "outside.element: elements of 4 m shorten the time step, and below 5 m nothing is gained"
MISSING = "outside.margin: under a load that stays for 10 s about 0.31 % of the displacement will be missing, more "
LASTING = {"wave": {"pulse": STAYS}, "outside.margin": 1}


@pytest.mark.parametrize(
    ("changes", "start"),
    [
        ({"outside.element": 20.0}, "outside.element: elements of 20 m return short waves, about 0.8"),
        ({"outside.layers": 2}, "outside.layers: 2 elements of order 4 return about 0.7 % of the displacement"),
        (
            {"outside.reflection": 0.01},
            STRONG,
        ),
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
    sides = {side: {"type": "outside"} for side in ("left", "right", "bottom", "top")}
    deep = {"ground.size": [100.0, 150.0], "packing.origin": [30.0, 0.0], "boundary": sides}
    deep |= {"load": [{"name": "f", "position": [50.5, 9.5], "force": [0.0, -1e6], "wave": "pulse"}]}

    assert warnings_of(case, **deep) == []
    (line,) = warnings_of(case, **deep, **{"outside.element": 5.0, "outside.margin": 2})
    start = "outside.margin: waves that the free surface sends back run along layers 10 m beside the disks, and about "
    assert line.startswith(start)
    assert line.endswith(" elements are enough")


def test_layers_of_strongly_anisotropic_ground(case) -> None:
    """They return more, which is said, and no formula says how much; one lattice below others is enough."""
    shear = {"material.kratio": 0.1, "material.pb_kratio": 0.1}
    assert ", 3 elements, R0 = 0.0001; they stretch both axes, " in facts_of(case, **shear)["absorbing layers"]
    (line,) = warnings_of(case, **shear)
    assert "those it needs return up to about 3 % of the motion, more than outside.accuracy = 0.1 %, and" in line
    assert warnings_of(case, **shear, **{"outside.accuracy": 0.04}) == []
    assert expected_errors(build(with_changes(case, shear)), {"here": np.array([20.0, 10.0])}) is None


def test_a_low_row_of_elements_has_a_warning(case) -> None:
    thin = {
        "outside.accuracy": 0.01,
        "layer": [{"thickness": 8.0, "density": 1800.0, "s_wave_speed": 350.0}, {"name": "seam", "thickness": 2.0}, {}],
    }
    (line,) = warnings_of(case, **thin)
    assert line.startswith("layer: a row of elements 2 m high beside layer seam shortens the time step to about 0.82 ")


def test_elements_too_large_beside_a_load(case) -> None:
    slow = {"wave.pulse.period": 20.0, "outside.element": 40.0}
    near = {"load": [{"name": "f", "position": [20.5, 4.5], "force": [0.0, -1e6], "wave": "pulse"}]}

    assert warnings_of(case, **slow) == []
    (line,) = warnings_of(case, **slow, **near)
    assert line.startswith(
        "outside.element: elements of 40 m are too large beside a load or hole, with an error of about 2"
    )

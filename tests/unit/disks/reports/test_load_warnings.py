"""Loads of which a side takes or holds a part."""

import pytest
from small_cases import small

from dembound.disks.reports.facts import disk_facts
from dembound.disks.reports.load_warnings import load_warnings
from dembound.disks.scene import build

GROUND = {
    "packing": {"pattern": "A", "size": [20.0, 10.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "wave": {"blow": {"type": "cosine", "amplitude": 1.0, "period": 0.05}},
    "run": {"duration": 0.01},
}


def scene(side: dict, **place: list):
    blow = {"name": "blow", "force": [3e5, -1e5], "wave": "blow", **place}
    return build(small(GROUND, changes={"boundary": {"left": side}, "load": [blow]}))


@pytest.mark.parametrize(
    ("side", "place", "said"),
    [
        ("viscous", {"position": [0.5, 5.5]}, "acts on disks of boundary.left alone, whose dashpots take a part of it"),
        ("viscous", {"position": [5.5, 5.5]}, None),
        ("viscous", {"region": [0.0, 0.0, 3.0, 10.0]}, None),
        ("free", {"position": [0.5, 5.5]}, None),
        (
            "fixed",
            {"position": [0.5, 5.5]},
            "has 100 % of its force along x on disks of boundary.left, ",
        ),
        ("fixed", {"region": [0.0, 0.0, 4.0, 10.0]}, "has 25 % of its force along x"),
        ("fixed", {"region": [0.0, 0.0, 20.0, 10.0]}, None),
        ("roller", {"position": [0.5, 5.5]}, "has 100 % of its force along x"),
    ],
)
def test_a_load_on_disks_of_a_side_is_warned_of(side: str, place: dict, said: str | None) -> None:
    found = list(load_warnings(scene({"type": side}, **place)))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]


def test_the_images_of_a_load_beside_a_plane_of_symmetry_are_counted() -> None:
    """They have the same force along the plane, and the opposite one across it."""
    facts = dict(disk_facts(scene({"type": "symmetry"}, position=[0.5, 5.5])))
    assert facts["load blow"].endswith("; with the images beyond left (0, -2e+05) N/m")
    assert "images" not in dict(disk_facts(scene({"type": "symmetry"}, position=[5.5, 5.5])))["load blow"]


def test_a_load_that_is_there_twice_is_warned_of() -> None:
    blow = {"name": "blow", "force": [3e5, 0.0], "position": [5.5, 5.5], "wave": "blow"}
    again, other = {**blow, "name": "again"}, {**blow, "name": "other", "position": [7.5, 5.5]}
    found = list(load_warnings(build(small(GROUND, changes={"load": [blow, other, again]}))))
    assert found == ["load.again: is the same as load.blow, so that it acts twice"]


@pytest.mark.parametrize(
    ("pull", "sides", "said"),
    [
        (9.81, ["left"], "static: the steady loads pull the body along x towards its right, which is free"),
        (-9.81, ["left"], ""),
        (9.81, ["left", "right"], ""),
        (-9.81, ["right"], "static: the steady loads pull the body along x towards its left, which is free"),
    ],
)
def test_a_body_that_hangs_while_it_settles_is_warned_of(pull: float, sides: list[str], said: str) -> None:
    held = {side: {"type": "fixed"} for side in sides}
    tables = {"load": [{"name": "weight", "acceleration": [pull, 0.0]}], "static": {"ratio": 1e-6, "boundary": held}}
    found = [line for line in load_warnings(build(small(GROUND | {"wave": {}} | tables))) if line.startswith("static:")]
    assert [line[: len(said)] for line in found] == ([said] if said else [])

"""Loads of which a side takes or holds a part."""

import pytest
from small_cases import small
from warned_cases import GROUND

from dembound.disks.scene import build
from dembound.kinds.disks.side_warnings import load_warnings


def scene(side: dict, **place: list):
    blow = {"name": "blow", "force": [3e5, -1e5], "wave": "blow", **place}
    return build(small(GROUND, changes={"boundary": {"left": side}, "load": [blow]}))


@pytest.mark.parametrize(
    ("side", "place", "said"),
    [
        ("viscous", {"position": [0.5, 5.5]}, "acts on disks of boundary.left alone, whose dashpots take a part of it"),
        ("free", {"position": [0.5, 5.5]}, None),
        ("fixed", {"region": [0.0, 0.0, 4.0, 10.0]}, "has 25 % of its force along x"),
        ("fixed", {"region": [0.0, 0.0, 20.0, 10.0]}, None),
    ],
)
def test_a_load_on_disks_of_a_side_is_warned_of(side: str, place: dict, said: str | None) -> None:
    found = list(load_warnings(scene({"type": side}, **place)))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]


@pytest.mark.parametrize(
    ("pull", "sides", "said"),
    [
        (9.81, ["left"], "static: the steady loads pull the body along x towards its right, which is free"),
        (-9.81, ["left"], ""),
        (-9.81, ["right"], "static: the steady loads pull the body along x towards its left, which is free"),
    ],
)
def test_a_body_that_hangs_while_it_settles_is_warned_of(pull: float, sides: list[str], said: str) -> None:
    held = {side: {"type": "fixed"} for side in sides}
    tables = {"load": [{"name": "weight", "acceleration": [pull, 0.0]}], "static": {"ratio": 1e-6, "boundary": held}}
    found = [line for line in load_warnings(build(small(GROUND | {"wave": {}} | tables))) if line.startswith("static:")]
    assert [line[: len(said)] for line in found] == ([said] if said else [])

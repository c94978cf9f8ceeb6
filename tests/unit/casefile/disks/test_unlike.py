"""Layers of one side: stacks of a case, and what they cannot go with."""

from typing import Any

import pytest
from small_cases import problems_in, small

from dembound.casefile import Case

SIDES: dict[str, Any] = {side: {"type": "outside"} for side in ("left", "right")}
LEFT = {"side": "left", "bottom": 8.0, "p_wave_speed": 600.0}
OTHERS = {"side": "right", "thickness": 9.0, "p_wave_speed": 800.0}, {"name": "rock"}
GROUND = {
    "ground": {"meet": 12.0},
    "packing": {"pattern": "A", "size": [24.0, 20.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "layer": [LEFT, *OTHERS],
    "boundary": SIDES | {"bottom": {"type": "outside", "wave_s": "w"}},
    "wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": 0.02}},
    "run": {"duration": 0.01},
}


def ground(**changes: object) -> Case:
    """Ground of unlike layers over rock, with changes."""
    return small(GROUND, changes=changes)


def test_a_side_has_its_own_layers_and_the_common_ones() -> None:
    case = ground()
    assert case.layer_planes == (11.0, 8.0)
    assert case.column_sides == ("left", "right", "bottom")
    assert case.middle == 12.0
    for side, joint, speed in (("left", 8.0, 600.0), ("right", 11.0, 800.0)):
        own = case.beside(side)
        assert not own.is_unlike
        assert own.layer_planes == (joint,)
        assert [each.p_wave_speed for each in own.materials] == [speed, 1000.0]
        assert own.beside("left") is own
        assert own.layer_names == ("1", "rock")
    assert case.layer_at(5.0) == 2
    assert case.uniform_at(5.0).layer_names == ("rock",)
    with pytest.raises(ValueError, match="differ at both sides"):
        case.layer_at(10.0)
    still = ground(**{"boundary.bottom": {"type": "outside"}, "outside.element": 4.0, "wave": {}})
    assert still.column_sides == ()


WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
ROLLERS = {side: {"type": "roller"} for side in ("left", "right", "bottom")}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"ground.meet": None}, "layer[1].side: needs ground.meet, the x (m) at which"),
        ({"layer": [{}]}, 'ground.meet: no layer has side = "left" or "right"'),
        ({"ground.meet": 3.0}, "ground.meet: is 3, must be from 4 to 20 (m): four diameters from the sides"),
        (
            {"layer": [LEFT | {"bottom": 5.0}, *OTHERS]},
            "layer[1].bottom: is at the left only, but the ground must be the same at both sides",
        ),
        (
            {"layer": [LEFT, {"thickness": 13.0, "p_wave_speed": 800.0}, {}]},
            "layer: common layers end at other heights at the left than at the right",
        ),
        ({"ground.size": [24.0, 20.0]}, "ground.size: is not allowed where the layers left and right"),
        ({"incident": {"type": "sv", "angle": 5.0, "wave": "w"}}, "incident: is not known where the layers left and"),
        ({"wave.w.motion": "within"}, 'wave.w.motion: is "within", which needs layers that are the same at both sides'),
        ({"static": {"stress": [-1e6, -1e6, 0.0]}}, "static.stress: is one stress of all the ground"),
        ({"boundary.top.type": "viscous"}, 'boundary.top.type: is "viscous", must be "free" where the layers left'),
        ({"boundary.left.type": "viscous"}, 'boundary.left.type: is "viscous", must be "outside" as other sides'),
        ({"boundary.left.type": "free_field"}, 'boundary.right.type: is "outside", must be "free_field" as other'),
        ({"boundary.left.type": "symmetry"}, 'boundary.left.type: is "symmetry", beyond which the same ground follows'),
        ({"load": [WEIGHT]}, "load[1, weight]: acts on all disks, which needs a [static] stage and no wave"),
        ({"load": [WEIGHT], "static": {"boundary": {"bottom": ROLLERS["bottom"]}}}, "static.boundary.left: must be"),
    ],
)
def test_mistakes_have_a_line_each(changes: dict[str, Any], line: str) -> None:
    found = problems_in(lambda: ground(**changes))
    assert any(each.startswith(line) for each in found), found

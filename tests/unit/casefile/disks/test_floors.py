"""Ground that is lower beyond a side: its detection, and tables that are impossible with it."""

import pytest
from small_cases import GROUND, Tables, small

from dembound.casefile import Case
from dembound.errors import CaseError

CUT = {"name": "cut", "type": "polygon", "points": [[10.0, 21.0], [18.0, 11.5], [31.0, 11.5], [31.0, 21.0]]}
SLOPE: Tables = GROUND | {"hole": [CUT]}
WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
FIXED, ROLLER = {"type": "fixed"}, {"type": "roller"}
STAGE = {"static": {"boundary": {"bottom": FIXED, "left": ROLLER, "right": FIXED}}}
WHY = (
    "as the ground is no half-space, with its surface at y = 11.5 m beyond the right side; end the holes inside the "
    "disks, with the surface at its height at both sides"
)


def problems(changes: Tables) -> list[str]:
    with pytest.raises(CaseError) as caught:
        small(SLOPE, changes=changes)
    return caught.value.problems


def staged(**sides: dict[str, str]) -> Case:
    """The slope settles under its weight, held at these sides."""
    return small(SLOPE, changes=WEIGHT | {"static": {"boundary": sides}})


def test_floors_are_those_of_all_holes() -> None:
    found = small(SLOPE).floors
    assert found.keys() == {"right"}
    assert found["right"].height == pytest.approx(11.5, abs=1e-12)
    second = {"name": "other", "type": "rectangle", "corners": [-1.0, 14.0, 6.0, 21.0], "stage": "after"}
    both = small(SLOPE, changes=WEIGHT | STAGE | {"hole": [CUT, second]})
    assert {side: floor.height for side, floor in both.floors.items()} == pytest.approx({"right": 11.5, "left": 14.0})
    assert both.floors_of(both.hole[1:]).keys() == {"left"}


def test_waves_that_need_a_half_space_are_refused() -> None:
    assert problems({"incident": {"type": "sv", "angle": 10.0, "wave": "w"}}) == [
        f"incident: what the surface sends back of the wave is not known, {WHY}"
    ]
    assert problems({"boundary.bottom.wave_p": "w"}) == [
        f"boundary.bottom.wave_p: the motion far from the disks is not known, {WHY}"
    ]


def test_loads_on_all_disks_need_a_stage() -> None:
    line = f"load[1, weight]: acts on all disks, which needs a [static] stage and no wave, {WHY}"
    for changes in (WEIGHT, {"load": [WEIGHT["load"][0] | {"wave": "w"}]} | STAGE):
        assert line in problems(changes)


def test_the_stage_holds_both_sides() -> None:
    settling = staged(bottom=FIXED, left=ROLLER, right=FIXED)
    assert settling.column_sides == ()
    line = 'static.boundary.{}: must be "roller" or "fixed", as the ground beyond is no half-space'
    for sides, wrong in (({}, ["left", "right"]), ({"left": ROLLER, "right": {"type": "free"}}, ["right"])):
        with pytest.raises(CaseError) as caught:
            staged(bottom=FIXED, **sides)
        assert caught.value.problems == [line.format(side) for side in wrong]

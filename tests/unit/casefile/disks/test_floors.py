"""Ground that is lower beyond a side: where it is found, and what cannot be there."""

import pytest

from dembound.errors import CaseError
from dembound.kinds import loads

CASE = """\
[packing]
pattern = "A"
size = [30.0, 20.0]
radius = 0.5
[material]
density = 2500.0
p_wave_speed = 1000.0
[boundary.left]
type = "outside"
[boundary.right]
type = "outside"
[boundary.bottom]
type = "outside"
{bottom}
[[hole]]
name = "cut"
type = "polygon"
points = [[10.0, 21.0], [18.0, 11.5], [31.0, 11.5], [31.0, 21.0]]
[wave.w]
type = "cosine"
amplitude = 1.0
period = 0.1
[run]
duration = 0.1
"""
WEIGHT = '[[load]]\nname = "weight"\nacceleration = [0.0, -9.81]\n'
STAGE = '[static.boundary.bottom]\ntype = "fixed"\n'
ROLLERS = '[static.boundary.left]\ntype = "roller"\n[static.boundary.right]\ntype = "fixed"\n'
WHY = (
    "as the ground is no half-space, with its surface at y = 11.5 m beyond the right side; end the holes inside the "
    "disks, with the surface at its height at both sides"
)


def case(more: str = "", bottom: str = ""):
    return loads(CASE.format(bottom=bottom) + more)


def problems(more: str = "", bottom: str = "") -> list[str]:
    with pytest.raises(CaseError) as caught:
        case(more, bottom)
    return caught.value.problems


def test_floors_are_those_of_all_holes() -> None:
    found = case().floors
    assert found.keys() == {"right"}
    assert found["right"].height == pytest.approx(11.5, abs=1e-12)
    second = '[[hole]]\nname = "other"\ntype = "rectangle"\ncorners = [-1.0, 14.0, 6.0, 21.0]\nstage = "after"\n'
    both = case(second + "[static]\n" + STAGE + ROLLERS + WEIGHT)
    assert {side: floor.height for side, floor in both.floors.items()} == pytest.approx({"right": 11.5, "left": 14.0})
    assert both.floors_of(both.hole[1:]).keys() == {"left"}


def test_below_the_surface_of_the_ground_there_are_none() -> None:
    deep = CASE.format(bottom="").replace("size = [30.0, 20.0]", "size = [30.0, 20.0]\norigin = [0.0, 10.0]")
    deep = "[ground]\nsize = [30.0, 40.0]\n" + deep.replace('[boundary.bottom]\ntype = "outside"', "")
    deep += "".join(f'[boundary.{side}]\ntype = "outside"\n' for side in ("bottom", "top"))
    assert loads(deep).floors == {}


def test_waves_that_need_a_half_space_are_refused() -> None:
    assert problems('[incident]\ntype = "sv"\nangle = 10.0\nwave = "w"\n') == [
        f"incident: what the surface sends back of the wave is not known, {WHY}"
    ]
    assert problems(bottom='wave_p = "w"') == [
        f"boundary.bottom.wave_p: the motion far from the disks is not known, {WHY}"
    ]


@pytest.mark.parametrize("more", [WEIGHT, WEIGHT + 'wave = "w"\n[static]\n' + STAGE + ROLLERS])
def test_loads_on_all_disks_need_a_stage(more: str) -> None:
    line = f"load[1, weight]: acts on all disks, which needs a [static] stage and no wave, {WHY}"
    assert line in problems(more)


def test_the_stage_holds_both_sides() -> None:
    settling = case(WEIGHT + "[static]\n" + STAGE + ROLLERS)
    assert settling.column_sides == ()
    line = 'static.boundary.{}: must be "roller" or "fixed", as the ground beyond is no half-space'
    assert problems(WEIGHT + "[static]\n" + STAGE) == [line.format("left"), line.format("right")]
    free = ROLLERS.replace('"fixed"', '"free"')
    assert problems(WEIGHT + "[static]\n" + STAGE + free) == [line.format("right")]

"""Mistakes of a box of disks in the ground, and where monitors and loads may be."""

import pytest

from dembound.casefile.disks.ground import reach
from dembound.errors import CaseError
from dembound.kinds import loads

FAR = float("inf")
PACKING = """\
[packing]
pattern = "B"
brick = [5.0, 10.0]
radius_ratio = 1.5
radius = 0.5
"""
REST = """\
[material]
density = 2500.0
p_wave_speed = 1000.0
[run]
duration = 0.1
"""
BOX = "size = [20.0, 20.0]\norigin = [20.0, 10.0]\n"
GROUND = "[ground]\nsize = [60.0, 40.0]\n"
ALL = ("left", "right", "bottom", "top")


def case(box: str = BOX, ground: str = GROUND, sides: tuple[str, ...] = ALL, more: str = ""):
    boundary = "".join(f'[boundary.{side}]\ntype = "outside"\n' for side in sides)
    return loads(ground + PACKING + box + REST + boundary + more)


def problems(**words) -> list[str]:
    with pytest.raises(CaseError) as caught:
        case(**words)
    return caught.value.problems


def test_a_box_in_the_ground() -> None:
    packing = case().packing
    assert packing.box == (20.0, 10.0, 40.0, 30.0)
    assert case().column_rows == (1, 4)
    assert case().size == (60.0, 40.0)


def test_disks_and_ground_may_begin_anywhere() -> None:
    filled = case(ground="", box="size = [20.0, 20.0]\norigin = [-30.0, 7.0]\n", sides=())
    assert filled.box == filled.packing.box == (-30.0, 7.0, -10.0, 27.0)
    assert filled.size == (20.0, 20.0)
    assert filled.column_rows == (0, 2)

    moved = case(box="size = [20.0, 20.0]\norigin = [-17.0, -23.0]\n", ground=GROUND + "origin = [-37.0, -33.0]\n")
    assert moved.box == (-37.0, -33.0, 23.0, 7.0)
    assert moved.column_rows == case().column_rows
    assert not moved.reaches_surface
    assert case(box="size = [20.0, 20.0]\norigin = [20.0, 20.0]\n", sides=ALL[:3]).reaches_surface


def test_the_box_lies_in_the_ground() -> None:
    for origin in ("[-1.0, 10.0]", "[20.0, 30.0]"):
        (line,) = problems(box=f"size = [20.0, 20.0]\norigin = {origin}\n")
        assert line.startswith("packing.origin: the box of disks is ")
        assert line.endswith(", must lie in the ground, [0, 0] to [60, 40] (m)")


def test_heights_are_whole_bricks() -> None:
    said = "m, is not a whole number of bricks of 10 m"
    assert problems(box="size = [20.0, 20.0]\norigin = [20.0, 12.0]\n") == [
        f"packing.origin: its height, 12 {said}; 10 or 20 would be"
    ]
    assert problems(ground="[ground]\nsize = [60.0, 45.0]\n") == [
        f"ground.size: its height, 45 {said}; 40 or 50 would be"
    ]
    assert case(box="size = [20.0, 20.0]\norigin = [17.3, 10.0]\n").packing.origin[0] == 17.3  # sideways it may be any


def test_where_the_ground_goes_on_a_side_is_outside() -> None:
    for missing, gap in (("left", "20"), ("top", "10")):
        others = tuple(side for side in ALL if side != missing)
        said = f'boundary.{missing}.type: the ground goes on {gap} m beyond this side, so it must be "outside"'
        assert problems(sides=others) == [said]
        assert problems(sides=others, more=f'[boundary.{missing}]\ntype = "viscous"\n') == [said]


def test_the_reach_of_monitors_and_loads() -> None:
    def found(**words) -> tuple[float, ...]:
        made = case(**words)
        return reach(made.ground, made.packing, made.boundary)

    assert found() == (-FAR, -FAR, FAR, 40.0)  # beside the ground too, above it nowhere
    assert found(box="size = [20.0, 20.0]\norigin = [0.0, 20.0]\n", sides=("right", "bottom")) == (0.0, -FAR, FAR, 40.0)
    away = "size = [20.0, 20.0]\norigin = [-30.0, -10.0]\n"
    assert found(box=away, ground=GROUND + "origin = [-50.0, -20.0]\n") == (-FAR, -FAR, FAR, 20.0)

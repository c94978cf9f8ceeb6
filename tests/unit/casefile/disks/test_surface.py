"""The surface of the ground as a line of points: in a case, in a file, and its mistakes."""

from pathlib import Path

import numpy as np
import pytest
import tomli_w
from small_cases import problems_in, small

from dembound.casefile import Case
from dembound.kinds import loads

GROUND = {
    "packing": {"pattern": "A", "size": [10.0, 6.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "run": {"duration": 0.01},
}
SLOPE = [[0.0, 6.0], [4.0, 6.0], [5.0, 2.0], [10.0, 2.0]]


def ground(**changes: object) -> Case:
    """Ground 10 m wide and 6 m high, with changes."""
    return small(GROUND, changes=changes)


def from_file(folder: Path, name: str = "s.csv") -> Case:
    """The same with its surface in a file of a folder."""
    return loads(tomli_w.dumps(GROUND | {"ground": {"surface": name}}), folder)


def test_what_is_above_the_surface_is_a_hole_that_reaches_beyond_the_disks() -> None:
    case = ground(**{"ground.surface": SLOPE})
    (air,) = case.holes
    places = np.array(
        [(2.0, 5.9), (4.6, 3.5), (4.4, 4.5), (4.6, 4.5), (9.9, 2.0), (9.9, 2.1), (-3.0, 5.9), (13.0, 3.0)]
    )
    assert air.takes(places, 10.0).tolist() == [False, False, True, True, False, True, False, True]
    assert case.hole == ()
    assert [place for place, _ in case.named_holes] == ["ground.surface"]
    assert {side: floor.height for side, floor in case.floors.items()} == pytest.approx({"right": 2.0})
    assert case.middle == pytest.approx(4.5, abs=0.1)
    assert case.ground.level().points == ()


def test_a_surface_may_stand_in_a_file(tmp_path: Path) -> None:
    for name, text in (("s.csv", "x (m),y (m)\n0,6\n4,6\n5,2\n10,2\n"), ("s.txt", "# x y in m\n0 6\n4 6\n5 2\n10 2\n")):
        (tmp_path / name).write_text(text)
        case = from_file(tmp_path, name)
        assert case.ground.points == tuple(map(tuple, SLOPE))
        assert case.files == {name: text}


def test_mistakes_have_a_line_each(tmp_path: Path) -> None:
    for points, line in (
        ([[0.0, 6.0]], "ground.surface: has 1 point, must have at least two"),
        ([[0.0, 6.0], [5.0, 2.0], [4.0, 2.0]], "ground.surface: must go from left to right, so that no x is less than"),
        ([[1.0, 6.0], [10.0, 2.0]], "ground.surface: goes from x = 1 to 10 m, must reach over the disks, 0 to 10 m"),
        ([[0.0, 7.0], [10.0, 2.0]], "ground.surface: is 7 m high, but packing.size ends at y = 6 m"),
        ([[0.0, 6.0], [10.0, 0.0]], "ground.surface: is as low as 0 m, must be above the lower side of the disks"),
    ):
        (found,) = problems_in(lambda points=points: ground(**{"ground.surface": points}))
        assert found.startswith(line)
    beside = {"ground.surface": [[0.0, 6.0], [1.0, 6.0], [5.0, 2.0], [8.0, 2.0], [10.0, 1.0]]}
    beyond = {f"boundary.{side}": {"type": "outside"} for side in ("left", "right")}
    assert problems_in(lambda: ground(**beside)) == []
    assert problems_in(lambda: ground(**beside, **beyond)) == [
        f"ground.surface: goes from y = {low:g} to {high:g} m beside boundary.{side}, beyond which it is level; "
        "must be level within half a diameter over 4 m there"
        for side, low, high in (("left", 3.0, 6.0), ("right", 1.0, 2.0))
    ]
    weight = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
    stage = {"static.boundary": {side: {"type": "roller"} for side in ("left", "right", "bottom")}}
    (found,) = problems_in(lambda: ground(**{"ground.surface": [[0.0, 6.0]]}, **beyond, **weight, **stage))
    assert found.startswith("ground.surface: has 1 point")  # nothing of its sides at rest, which follow from it
    for text, line in (
        ("0,6\n10,six\n", "is not two columns of numbers"),
        ("0,6,1\n10,2,1\n", "has 3 columns, must have two, x and y in m"),
        ("x (ft),y (ft)\n0,6\n10,2\n", 'names "ft", must be in m'),
        ("x in,y in\n0,6\n10,2\n", 'names "in", must be in m'),
    ):
        (tmp_path / "s.csv").write_text(text)
        (found,) = problems_in(lambda: from_file(tmp_path))
        assert found.startswith("ground.surface: ")
        assert line in found
    (found,) = problems_in(lambda: from_file(tmp_path, "none.csv"))
    assert "no file" in found


def test_places_above_the_surface_are_refused() -> None:
    monitor = {"name": "bird", "position": [8.0, 4.0]}
    (found,) = problems_in(lambda: ground(**{"ground.surface": SLOPE, "monitor": [monitor]}))
    assert found == "monitor[1, bird].position: lies in the air above ground.surface; must be where particles remain"

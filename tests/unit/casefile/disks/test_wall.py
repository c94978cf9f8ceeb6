"""The [[wall]] table: points in a case or a file, motion, and mistakes."""

from pathlib import Path

import pytest
import tomli_w
from small_cases import problems_in, small

from dembound.kinds import loads

FLOOR = {"name": "floor", "points": [[-1.0, 0.0], [20.0, 0.0]]}
LOOSE = {
    "packing": {"pattern": "A", "size": [4.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5},
    "wall": [FLOOR],
    "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 0.1}},
    "run": {"duration": 0.01},
}


def test_points_may_stand_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "valley.csv").write_text("x (m),y (m)\n-1,0\n20,0\n")
    case = loads(tomli_w.dumps(LOOSE | {"wall": [FLOOR | {"points": "valley.csv"}]}), tmp_path)
    assert case.wall[0].line == ((-1.0, 0.0), (20.0, 0.0)) == small(LOOSE).wall[0].line
    assert case.files == {"valley.csv": "x (m),y (m)\n-1,0\n20,0\n"}


def test_disks_touch_walls_from_the_start_and_waves_move_them() -> None:
    case = small(LOOSE | {"wall": [FLOOR | {"wave_y": "push", "until": 0.05}]})
    assert not case.begins_elastic
    assert small(LOOSE | {"wall": []}).begins_elastic
    assert case.wall[0].is_driven
    assert case.wall[0].waves == {1: "push"}
    assert case.moving == {"push"}


@pytest.mark.parametrize(
    ("wall", "line"),
    [
        ({"points": [[0.0, 0.0]]}, "wall[1, floor].points: has 1 point, must have 2 to 100,000"),
        (
            {"points": [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]]},
            "wall[1, floor].points: has point 1 twice in a row, at (0, 0)",
        ),
        ({"velocity": [1.0, 0.0], "wave_x": "push"}, "wall[1, floor].wave_x: is not allowed together with velocity"),
        ({"until": 0.1}, "wall[1, floor].until: is of a wall that moves; give velocity, wave_x or wave_y"),
        (
            {"moves": "incident"},
            'wall[1, floor].moves: is "incident", but the motion of the ground beyond is not known',
        ),
        ({"moves": "incident", "until": 0.1}, "wall[1, floor].until: is not allowed together with moves"),
        ({"at": [0.0, 0.0]}, "wall[1, floor].at: is of a wall that moves as the ground; give moves"),
        ({"rr_fric": 0.3}, "wall[1, floor].rr_fric: is of disks that roll, but with fric = 0 they slide"),
        ({"wave_x": "pull"}, 'wall[1, floor].wave_x: "pull" is not a wave of this case; defined: push'),
    ],
)
def test_mistakes_in_a_wall_have_a_line_each(wall: dict, line: str) -> None:
    (found,) = problems_in(lambda: small(LOOSE | {"wall": [FLOOR | wall]}))
    assert found.startswith(line)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"material": {"density": 2500.0, "p_wave_speed": 1e3}},
            'wall[1, floor]: material.law is "elastic", under which',
        ),
        ({"wall": [FLOOR, FLOOR]}, 'wall[2].name: "floor" is taken by wall[1]'),
        (
            {"boundary": {side: {"type": "periodic"} for side in ("left", "right")}},
            'wall[1, floor]: boundary.left is "per',
        ),
        (
            {"output": {"estimate": True}, "monitor": [{"name": "a", "position": [1.0, 1.0]}]},
            "output.estimate: is true, but",
        ),
        (
            {"material": {"density": 2500.0, "law": "hertz", "hz_shear": 1e9, "hz_poiss": 0.2, "fric": 0.5}},
            "wall[1, floor].kn: is missing; the contacts of material have no emod",
        ),
    ],
)
def test_what_walls_do_not_go_with_is_refused_by_name(changes: dict, line: str) -> None:
    (found,) = problems_in(lambda: small(LOOSE | changes))
    assert found.startswith(line)


def test_a_body_may_rest_on_walls_alone() -> None:
    weight = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}], "static": {}}
    assert small(LOOSE | weight).static is not None
    assert "nothing holds the body along y" in problems_in(lambda: small(LOOSE | weight | {"wall": []}))[0]
    (found,) = problems_in(lambda: small(LOOSE | weight | {"static": {"k0": 0.5}}))
    assert found.endswith('give a side "fixed" or "roller", under k0 also above walls')

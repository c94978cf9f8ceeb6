"""Loads: what acts and where, alone and beside the other tables."""

import pytest

from dembound.casefile.disks.load import Load
from dembound.errors import CaseError
from dembound.kinds import loads

BASE = """\
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.25
[material]
density = 2500.0
p_wave_speed = 1000.0
[run]
duration = 0.1
[wave.tap]
type = "cubic_spline"
amplitude = 1.0
period = 0.05
"""


def load(*keys: str, name: str = "a") -> str:
    return "\n".join(["[[load]]", f'name = "{name}"', *keys, ""])


def problems(extra: str) -> list[str]:
    try:
        loads(BASE + extra)
    except CaseError as error:
        return error.problems
    return []


@pytest.mark.parametrize(
    ("keys", "vector", "axes"),
    [
        ({"force": (0.0, -4.5e5), "position": (5.0, 5.0)}, (0.0, -4.5e5), (1,)),
        ({"force": (1.0, 2.0), "region": (0.0, 0.0, 1.0, 5.0), "wave": "tap"}, (1.0, 2.0), (0, 1)),
        ({"acceleration": (0.0, -9.81)}, (0.0, -9.81), (1,)),
        ({"acceleration": (3.0, 0.0), "position": (1.0, 1.0)}, (3.0, 0.0), (0,)),
    ],
)
def test_complete_loads_say_what_acts_along_which_axes(
    keys: dict[str, object], vector: tuple[float, float], axes: tuple[int, ...]
) -> None:
    complete = Load(name="a", **keys)
    assert (complete.key in keys, complete.vector, complete.axes) == (True, vector, axes)


@pytest.mark.parametrize(
    ("keys", "lines"),
    [
        ([], ["load[1, a].force: is missing; give one of force, acceleration, pressure"]),
        (
            ["force = [1.0, 0.0]"],
            ["load[1, a].position: is missing; a force needs either position or region"],
        ),
        (
            ["force = [1.0, 0.0]", "acceleration = [1.0, 0.0]", "position = [1.0, 1.0]"],
            ["load[1, a].acceleration: is not allowed together with force"],
        ),
        (
            ["acceleration = [0.0, 0]", "position = [1.0, 1.0]", "region = [0.0, 0.0, 1.0, 1.0]"],
            [
                "load[1, a].acceleration: is zero along x and y, must not be",
                "load[1, a].region: is not allowed together with position",
            ],
        ),
        (
            ["force = [1.0, 0.0]", "region = [1.0, 0.0, 1.0, 5.0]"],
            ["load[1, a].region: must have x0 < x1 and y0 < y1, in the order x0, y0, x1, y1"],
        ),
        (
            ["force = [1.0]", "position = [1.0, 1.0]"],
            ["load[1, a].force: is [1.0], must be a list of 2 values, each a number (N/m)"],
        ),
        (
            ["pressure = 1e6", "force = [1.0, 0.0]", "position = [1.0, 1.0]"],
            [
                "load[1, a].pressure: is not allowed together with force",
                "load[1, a].hole: is missing; a pressure needs the name of a hole",
                "load[1, a].position: is not allowed together with pressure; give hole",
            ],
        ),
        (["pressure = 0", 'hole = "h"'], ["load[1, a].pressure: is zero, must not be"]),
        (
            ["force = [1.0, 0.0]", "position = [1.0, 1.0]", 'hole = "h"', 'on = "bonds"'],
            ["load[1, a].hole: is for a pressure", "load[1, a].on: is for a pressure"],
        ),
        (
            ["pressure = 1e6", 'hole = "h"', 'on = "ring"'],
            ['load[1, a].on: is "ring", must be one of "outline", "bonds"'],
        ),
        # beside the other tables
        (
            ["force = [1.0, 0.0]", "position = [10.5, 1.0]"],
            ["load[1, a].position: is [10.5, 1.0], must be in the scene, [0, 0] to [10, 5] (m)"],
        ),
        (
            ["force = [1.0, 0.0]", "region = [0.0, 0.0, 6.0, 5.5]"],
            ["load[1, a].region: is [0.0, 0.0, 6.0, 5.5], must be in the scene, [0, 0] to [10, 5] (m)"],
        ),
        (
            ["acceleration = [1.0, 0.0]", 'wave = "top"'],
            ['load[1, a].wave: "top" is not a wave of this case; defined: tap'],
        ),
    ],
)
def test_each_mistake_gets_one_plain_line(keys: list[str], lines: list[str]) -> None:
    assert problems(load(*keys)) == lines


def hole(keys: str, name: str = "tunnel") -> str:
    return f'[[hole]]\nname = "{name}"\n{keys}\n'


CIRCLE = 'type = "circle"\ncentre = [3.0, 2.0]\nradius = 1.0'
BOW_TIE = 'type = "polygon"\npoints = [[2, 1], [4, 3], [4, 1], [2, 3]]'
PRESSED = load("pressure = 1e6", 'hole = "tunnel"')


def test_a_pressure_acts_on_a_hole_of_the_case_and_on_nothing_else() -> None:
    case = loads(BASE + hole(CIRCLE) + PRESSED)
    (pressed,) = case.load

    assert (pressed.key, pressed.axes, pressed.on, pressed.is_everywhere) == ("pressure", (0, 1), "outline", False)
    assert case.hole_of(pressed).name == "tunnel"
    assert problems(PRESSED) == ['load[1, a].hole: "tunnel" is not a hole of this case; none is defined']
    assert problems(hole(CIRCLE, "tunnels") + PRESSED) == [
        'load[1, a].hole: "tunnel" is not a hole of this case; defined: tunnels (did you mean tunnels?)'
    ]


def test_a_pressure_needs_an_outline_without_crossings_unless_it_is_on_bonds() -> None:
    assert problems(hole(BOW_TIE) + PRESSED) == [
        'load[1, a].on: "outline" needs edges that do not cross; give hole tunnel such, or on = "bonds"'
    ]
    assert problems(hole(BOW_TIE) + load("pressure = 1e6", 'hole = "tunnel"', 'on = "bonds"')) == []


@pytest.mark.parametrize(("centre", "is_refused"), [(1.0, True), (1.01, False), (8.99, False), (9.0, True)])
def test_a_pressure_cannot_act_where_a_periodic_side_closes_the_wall(centre: float, is_refused: bool) -> None:
    sides = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'
    found = problems(sides + hole(CIRCLE.replace("3.0", str(centre))) + PRESSED)
    side = "left" if centre < 5.0 else "right"

    assert found == [
        f'load[1, a].hole: "tunnel" reaches the periodic side {side}, which closes its wall otherwise'
    ] * int(is_refused)


def test_a_steady_pressure_alone_is_settled_without_supports() -> None:
    assert problems("[static]\n" + hole(CIRCLE) + PRESSED) == []


def test_a_pressure_needs_both_directions_free() -> None:
    assert problems('[motion]\nheld = ["y"]\n' + hole(CIRCLE) + PRESSED) == [
        "load[1, a].pressure: acts along y, which motion.held holds for every particle"
    ]


def test_a_wave_may_drive_a_load_and_loads_keep_their_order() -> None:
    gravity = load("acceleration = [0.0, -9.81]", name="gravity")
    tap = load("force = [0, -1]", "region = [0, 0, 10, 5]", 'wave = "tap"', name="tap")

    case = loads(BASE + gravity + tap)

    assert [(entry.name, entry.wave) for entry in case.load] == [("gravity", None), ("tap", "tap")]


def test_names_are_unique_and_serve_as_file_names() -> None:
    gravity = "acceleration = [0.0, -9.81]"
    assert problems(load(gravity) + load(gravity, name="b") + load(gravity)) == [
        'load[3].name: "a" is taken by load[1]'
    ]
    (line,) = problems(load(gravity, name="a/b"))
    assert line.startswith('load[1, a/b].name: is "a/b", must be made of the letters')


def test_a_held_direction_cannot_be_loaded() -> None:
    held = '[motion]\nheld = ["x"]\n'
    assert problems(held + load("acceleration = [0.0, 1.0]")) == []
    assert problems(held + load("acceleration = [1.0, 1.0]")) == [
        "load[1, a].acceleration: acts along x, which motion.held holds for every particle"
    ]

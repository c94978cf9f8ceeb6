"""Loads: their kind and place, alone and together with other tables."""

import pytest
from small_cases import BODY, problems_of, rows

from dembound.kinds import loads

TAP = '[wave.tap]\ntype = "cubic_spline"\namplitude = 1.0\nperiod = 0.05\n'


def load(*keys: str, name: str = "a") -> str:
    return "\n".join(["[[load]]", f'name = "{name}"', *keys, ""])


def problems(extra: str) -> list[str]:
    return problems_of(BODY + TAP + extra)


MISTAKES = r"""
 | .force: is missing; give one of force, acceleration, pressure
force = [1, 0] | .position: is missing; a force needs either position or region
acceleration = [0, 0]\nposition = [1, 1] | .acceleration: is zero along x and y, must not be
pressure = 1e6 | .hole: is missing; a pressure needs the name of a hole, or sides
force = [1, 0]\nposition = [1, 1]\nhole = "h" | .hole: is for a pressure
force = [1, 0]\nposition = [10.5, 1.0] | .position: is [10.5, 1.0], must be in the scene, [0, 0] to [10, 5] (m)
force = [1, 0]\nregion = [0, 0, 6, 5.5] | .region: is [0.0, 0.0, 6.0, 5.5], must be in the scene, [0, 0] to [10, 5] (m)
"""


@pytest.mark.parametrize(("keys", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(keys: str, line: str) -> None:
    assert problems(load(keys)) == [f"load[1, a]{line}"]


def hole(keys: str, name: str = "tunnel") -> str:
    return f'[[hole]]\nname = "{name}"\n{keys}\n'


CIRCLE = 'type = "circle"\ncentre = [3.0, 2.0]\nradius = 1.0'
BOW_TIE = 'type = "polygon"\npoints = [[2, 1], [4, 3], [4, 1], [2, 3]]'
PRESSED = load("pressure = 1e6", 'hole = "tunnel"')


def test_a_pressure_acts_on_a_hole_of_the_case_and_on_nothing_else() -> None:
    case = loads(BODY + hole(CIRCLE) + PRESSED)
    (pressed,) = case.load
    assert (pressed.key, pressed.axes, pressed.on, pressed.is_everywhere) == ("pressure", (0, 1), "outline", False)
    assert case.hole_of(pressed).name == "tunnel"
    assert problems(PRESSED) == ['load[1, a].hole: "tunnel" is not a hole of this case; none is defined']
    assert problems(hole(CIRCLE, "tunnels") + PRESSED) == [
        'load[1, a].hole: "tunnel" is not a hole of this case; defined: tunnels (did you mean tunnels?)'
    ]
    assert problems("[static]\n" + hole(CIRCLE) + PRESSED) == []  # steady, it needs no supports


def test_a_pressure_needs_an_outline_without_crossings_unless_it_is_on_bonds() -> None:
    assert problems(hole(BOW_TIE) + PRESSED) == [
        'load[1, a].on: "outline" needs edges that do not cross; give hole tunnel such, or on = "bonds"'
    ]
    assert problems(hole(BOW_TIE) + load("pressure = 1e6", 'hole = "tunnel"', 'on = "bonds"')) == []


def test_a_pressure_cannot_act_where_a_periodic_side_closes_the_wall() -> None:
    sides = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'
    for centre, side in ((1.0, "left"), (1.01, ""), (8.99, ""), (9.0, "right")):
        line = f'load[1, a].hole: "tunnel" reaches the periodic side {side}, which closes its wall otherwise'
        found = problems(sides + hole(CIRCLE.replace("3.0", str(centre))) + PRESSED)
        assert found == ([line] if side else [])


def test_a_held_direction_cannot_be_loaded() -> None:
    line = "load[1, a].{}: acts along {}, which motion.held holds for every particle"
    held = '[motion]\nheld = ["x"]\n'
    assert problems(held + load("acceleration = [0.0, 1.0]")) == []
    assert problems(held + load("acceleration = [1.0, 1.0]")) == [line.format("acceleration", "x")]
    assert problems('[motion]\nheld = ["y"]\n' + hole(CIRCLE) + PRESSED) == [line.format("pressure", "y")]

"""The static stage: its keys, its sides, and what it needs from the other tables."""

import pytest

from dembound.casefile.types import BOUNDARIES
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.table import name_of

BASE = """\
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.25
[run]
duration = 0.1
"""
ELASTIC = "[material]\ndensity = 2500.0\np_wave_speed = 1000.0\n"
BREAKABLE = ELASTIC + 'law = "linearpbond"\n'
STRESS = "[static]\nstress = [-1e6, -1e6, 0]\n"
GRAVITY = '[[load]]\nname = "gravity"\nacceleration = [0.0, -9.81]\n'
TAP = GRAVITY + 'wave = "tap"\n[wave.tap]\ntype = "ricker"\namplitude = 1.0\nfrequency = 20.0\n'
PERIODIC = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'
FREE_FIELD = PERIODIC.replace("periodic", "free_field")
SIDES = ", ".join(sorted(f'"{name_of(side)}"' for side in BOUNDARIES if side.for_static))
UPRIGHT_PERIODIC = PERIODIC.replace("left", "bottom").replace("right", "top")


def problems(*tables: str, material: str = ELASTIC) -> list[str]:
    try:
        loads("".join([BASE, material, *tables]))
    except CaseError as error:
        return error.problems
    return []


def side(name: str, kind: str) -> str:
    return f'[static.boundary.{name}]\ntype = "{kind}"\n'


def test_a_stage_is_read_with_its_sides_in_order() -> None:
    static = loads(BASE + ELASTIC + STRESS + side("bottom", "roller") + side("left", "fixed")).static

    assert (static.stress, static.ratio, static.damp, static.max_steps) == ((-1e6, -1e6, 0.0), 1e-5, 0.7, 200_000)
    assert [(name, table.type) for name, table in static.boundary.items()] == [("left", "fixed"), ("bottom", "roller")]


def test_stages_are_equal_when_their_tables_are() -> None:
    one, same, other = (
        loads(BASE + ELASTIC + STRESS + side("left", kind)).static for kind in ("fixed", "fixed", "roller")
    )
    assert one == same
    assert one != other


@pytest.mark.parametrize(
    ("tables", "lines"),
    [
        ("ratio = 1", ["static.ratio: is 1, must be less than 1"]),
        ("damp = 0.0", ["static.damp: is 0.0, must be greater than 0"]),
        ("max_steps = 0", ["static.max_steps: is 0, must be at least 1"]),
        (
            "dump = 0.5",
            [
                "static.dump: unknown key; allowed: stress, ratio, damp, max_steps, from, boundary "
                "(did you mean damp?)",
            ],
        ),
        ("boundary = 1", ["static.boundary: is 1, must be made of tables [static.boundary.NAME]"]),
        (
            side("lefd", "free"),
            ["static.boundary.lefd: unknown side; allowed: left, right, bottom, top (did you mean left?)"],
        ),
        (
            side("left", "viscous"),
            [f'static.boundary.left.type: is "viscous", must be one of {SIDES}'],
        ),
        ("boundary.left = {}", [f"static.boundary.left.type: is missing, must be one of {SIDES}"]),
        (side("top", "free") + "x = 1\n", ["static.boundary.top.x: unknown key; allowed: type, artificial"]),
        (
            side("top", "fixed") + "artificial = false\n",
            ["static.boundary.top.artificial: is of no use in the static stage; give it to boundary.top"],
        ),
        (
            "damp = 2\n" + side("left", "wall") + side("top", "wall"),
            [
                f'static.boundary.left.type: is "wall", must be one of {SIDES} (here "fixed")',
                f'static.boundary.top.type: is "wall", must be one of {SIDES} (here "fixed")',
                "static.damp: is 2, must be less than 1",
            ],
        ),
    ],
)
def test_each_mistake_gets_one_plain_line(tables: str, lines: list[str]) -> None:
    assert problems(STRESS, tables) == lines


def test_stress_has_three_components() -> None:
    assert problems("[static]\nstress = [1.0, 1.0]\n") == [
        "static.stress: is [1.0, 1.0], must be a list of 3 values, each a number (Pa)"
    ]


def test_a_locked_in_stress_needs_a_stage() -> None:
    locked_in = BREAKABLE + "locked_in = 1e6\n"
    line = "material.locked_in: is a stress that is not in equilibrium at cut sides; must relax in a [static] stage"
    assert problems("", material=locked_in) == [line]
    assert problems("[static]\n", material=locked_in) == []


def test_a_stage_needs_something_to_settle() -> None:
    line = "static: has nothing to settle; give it a stress, give the case a steady load, or the material locked_in"
    assert problems(STRESS) == []
    assert problems("[static]\n", side("bottom", "fixed"), GRAVITY) == []
    assert problems("[static]\nstress = [0, 0, 0]\n") == []  # to rest without any stress is a wish, too
    assert problems("[static]\n", material=BREAKABLE + "locked_in = 1e6\n") == []
    assert problems("[static]\n") == [line]
    assert problems("[static]\n", TAP) == [line]
    assert problems("[static]\n", material=BREAKABLE) == [line]
    # an invalid load may have been a steady one
    assert len(problems("[static]\n", GRAVITY + "position = [1.0]\n")) == 1


@pytest.mark.parametrize(("name", "kind"), [("left", "fixed"), ("top", "fixed"), ("top", "roller")])
def test_any_support_along_the_load_holds_the_body(name: str, kind: str) -> None:
    assert problems("[static]\n", side(name, kind), GRAVITY) == []


@pytest.mark.parametrize("tables", ["", side("bottom", "free"), side("left", "roller"), UPRIGHT_PERIODIC])
def test_a_steady_load_that_nothing_holds_is_refused(tables: str) -> None:
    assert problems("[static]\n", tables, GRAVITY) == [
        'static.boundary: nothing holds the body along y against load[1, gravity]; give a side "fixed" or "roller"'
    ]


def test_loads_that_come_and_go_need_no_hold() -> None:
    assert problems(STRESS, TAP) == []


@pytest.mark.parametrize(
    ("tables", "line"),
    [
        (side("left", "fixed") + side("right", "roller"), "x, but left and right are held there"),
        (side("bottom", "fixed") + side("top", "fixed"), "y, but bottom and top are held there"),
    ],
)
def test_a_stress_that_cannot_be_reached_is_refused(tables: str, line: str) -> None:
    assert problems(STRESS, tables) == [f"static.stress: has a component along {line}; free one of them"]


@pytest.mark.parametrize("across", ["fixed", "roller"])
def test_a_stress_is_reached_against_one_side_or_between_walls_along_it(across: str) -> None:
    assert problems(STRESS, side("bottom", "roller")) == []
    assert problems(STRESS.replace("-1e6, -1e6", "0, -1e6"), side("left", across), side("right", across)) == []


def test_periodic_sides_take_no_support_and_no_stress() -> None:
    assert problems(PERIODIC, STRESS, side("left", "roller")) == [
        "static.boundary.left: is not allowed, as boundary.left is periodic",
        'static.stress: cannot be applied at boundary.left ("periodic"), boundary.right ("periodic"); "viscous" or '
        '"viscoelastic" sides absorb and take it, or leave it out and let gravity make it (a [[load]] with an '
        "acceleration)",
    ]
    assert problems(PERIODIC, "[static]\n", side("bottom", "fixed"), GRAVITY) == []


def test_free_field_sides_take_supports_but_no_stress() -> None:
    (line,) = problems(FREE_FIELD, STRESS)
    assert line.startswith('static.stress: cannot be applied at boundary.left ("free_field"), boundary.right ("free_fi')
    assert problems(FREE_FIELD, "[static]\n", side("left", "roller"), side("bottom", "fixed"), GRAVITY) == []


def test_the_column_beside_a_free_field_side_is_held_from_below_or_above() -> None:
    line = (
        "static.boundary: nothing holds the free-field column along y against load[1, gravity]; "
        'give bottom or top "fixed" or "roller"'
    )
    tap = GRAVITY.replace("acceleration", "force") + "position = [5.0, 2.5]\n"
    for name in ("bottom", "top"):
        assert problems(FREE_FIELD, "[static]\n", side(name, "roller"), GRAVITY) == []
    assert problems(FREE_FIELD, "[static]\n", side("left", "fixed"), GRAVITY) == [line]
    # what acts on the body alone may be carried by its sides
    assert problems(FREE_FIELD, "[static]\n", side("left", "fixed"), tap) == []


def test_a_held_axis_is_reported_once() -> None:
    assert problems(STRESS, GRAVITY, '[motion]\nheld = ["y"]\n') == [
        "load[1, gravity].acceleration: acts along y, which motion.held holds for every particle"
    ]

"""The static stage: its keys, its sides, and what it needs from the other tables."""

import pytest
from small_cases import problems_of, rows

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
UPRIGHT_PERIODIC = PERIODIC.replace("left", "bottom").replace("right", "top")


def problems(*tables: str, material: str = ELASTIC) -> list[str]:
    return problems_of("".join([BASE, material, *tables]))


def side(name: str, kind: str) -> str:
    return f'[static.boundary.{name}]\ntype = "{kind}"\n'


MISTAKES = r"""
ratio = 1 | .ratio: is 1, must be less than 1
dump = 0.5 | .dump: unknown key; allowed: stress, k0, ratio, damp, max_steps, from, boundary (did you mean damp?)
boundary.lefd.type = "free" | .boundary.lefd: unknown side; allowed: left, right, bottom, top (did you mean left?)
boundary.top = {type = "free", x = 1} | .boundary.top.x: unknown key; allowed: type, artificial
boundary.top = {type = "fixed", artificial = false} | .boundary.top.artificial: is of no use in the static stage; give i
"""


@pytest.mark.parametrize(("keys", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(keys: str, line: str) -> None:
    (found,) = problems(STRESS, keys)
    assert found.startswith(f"static{line}")


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


def test_a_steady_load_is_held_by_any_support_along_it() -> None:
    line = 'static.boundary: nothing holds the body along y against load[1, gravity]; give a side "fixed" or "roller"'
    for tables in (side("left", "fixed"), side("top", "fixed"), side("top", "roller")):
        assert problems("[static]\n", tables, GRAVITY) == []
    for tables in ("", side("bottom", "free"), side("left", "roller"), UPRIGHT_PERIODIC):
        assert problems("[static]\n", tables, GRAVITY) == [line]
    assert problems(STRESS, TAP) == []  # what comes and goes needs no hold
    # a held axis is reported once
    assert problems(STRESS, GRAVITY, '[motion]\nheld = ["y"]\n') == [
        "load[1, gravity].acceleration: acts along y, which motion.held holds for every particle"
    ]


def test_a_stress_that_cannot_be_reached_is_refused() -> None:
    for tables, line in (
        (side("left", "fixed") + side("right", "roller"), "x, but left and right are held there"),
        (side("bottom", "fixed") + side("top", "fixed"), "y, but bottom and top are held there"),
    ):
        assert problems(STRESS, tables) == [f"static.stress: has a component along {line}; free one of them"]
    # against one side, or between walls along it, it is
    assert problems(STRESS, side("bottom", "roller")) == []
    for across in ("fixed", "roller"):
        assert problems(STRESS.replace("-1e6, -1e6", "0, -1e6"), side("left", across), side("right", across)) == []


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


def test_k0_needs_weight_and_no_stress_of_the_packing() -> None:
    k0, bottom = "[static]\nk0 = 0.5\n", side("bottom", "fixed")
    weightless = (
        "static.k0: is of the stress due to weight; give a [[load]] with acceleration = [0.0, -9.81] and no wave"
    )
    assert problems(k0, bottom, GRAVITY) == problems(FREE_FIELD, k0, bottom, GRAVITY) == []
    (weightless,) = problems(k0 + "stress = [-1e6, 0.0, 0.0]\n", bottom)
    assert weightless.startswith("static.k0: is of the stress due to weight; give a [[load]] with acceleration = ")
    locked = "material.locked_in: is not allowed beside a stress at rest; leave it out and give all in static.stress"
    assert problems(k0, bottom, GRAVITY, material=BREAKABLE + "locked_in = 1e6\n") == [locked]

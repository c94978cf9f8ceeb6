"""The static stage: its keys, its sides, what it needs from other tables, and where it keeps bonds from breaking."""

import pytest
from small_cases import GRAINS, around, problems_of, rows, small

from dembound.boundaries.viscous import Bearing
from dembound.casefile.disks import DiskCase

BASE = 'packing = {pattern = "A", size = [10.0, 5.0], radius = 0.25}\nrun.duration = 0.1\n'
ELASTIC = "[material]\ndensity = 2500.0\np_wave_speed = 1000.0\n"
BREAKABLE = ELASTIC + 'law = "linearpbond"\n'
LOCKED_IN = BREAKABLE + "locked_in = 1e6\n"
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


def test_a_stage_needs_something_to_settle_and_a_locked_in_stress_needs_a_stage() -> None:
    line = "static: has nothing to settle; give it a stress, give the case a steady load, or the material locked_in"
    assert problems(STRESS) == []
    assert problems("[static]\n", side("bottom", "fixed"), GRAVITY) == []
    assert problems("[static]\nstress = [0, 0, 0]\n") == []  # to rest without any stress is a wish, too
    assert problems("[static]\n", material=LOCKED_IN) == []
    assert problems("[static]\n") == problems("[static]\n", TAP) == problems("[static]\n", material=BREAKABLE) == [line]
    # an invalid load may have been a steady one
    assert len(problems("[static]\n", GRAVITY + "position = [1.0]\n")) == 1
    locked = "material.locked_in: is a stress that is not in equilibrium at cut sides; must relax in a [static] stage"
    assert problems(material=LOCKED_IN) == [locked]


def test_a_steady_load_is_held_by_any_support_along_it() -> None:
    line = 'static.boundary: nothing holds the body along y against load[1, gravity]; give a side "fixed" or "roller"'
    for tables in (side("left", "fixed"), side("top", "fixed"), side("top", "roller")):
        assert problems("[static]\n", tables, GRAVITY) == []
    for tables in ("", side("bottom", "free"), side("left", "roller"), UPRIGHT_PERIODIC):
        assert problems("[static]\n", tables, GRAVITY) == [line]
    assert problems(STRESS, TAP) == []  # what comes and goes needs no hold
    # a held axis is reported once
    held = "load[1, gravity].acceleration: acts along y, which motion.held holds for every particle"
    assert problems(STRESS, GRAVITY, '[motion]\nheld = ["y"]\n') == [held]


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
    said = "static.boundary: nothing holds the free-field column along y against load[1, gravity]"
    tap = GRAVITY.replace("acceleration", "force") + "position = [5.0, 2.5]\n"
    for name in ("bottom", "top"):
        assert problems(FREE_FIELD, "[static]\n", side(name, "roller"), GRAVITY) == []
    held = (FREE_FIELD, "[static]\n", side("left", "fixed"))
    assert problems(*held, GRAVITY) == [f'{said}; give bottom or top "fixed" or "roller"']
    pushed = GRAVITY.replace("[0.0, -9.81]", "[1.0, 0.0]")  # along which rollers at the bottom let it go
    said = said.replace("along y", "along x")
    assert problems(FREE_FIELD, "[static]\n", side("bottom", "roller"), pushed) == [
        f'{said}; give bottom or top "fixed"'
    ]
    assert problems(*held, tap) == []  # what acts on the body alone may be carried by its sides


def test_k0_needs_weight_and_no_stress_of_the_packing() -> None:
    k0, bottom = "[static]\nk0 = 0.5\n", side("bottom", "fixed")
    assert problems(k0, bottom, GRAVITY) == problems(FREE_FIELD, k0, bottom, GRAVITY) == []
    (weightless,) = problems(k0 + "stress = [-1e6, 0.0, 0.0]\n", bottom)
    assert weightless.startswith("static.k0: is of the stress due to weight; give a [[load]] with acceleration = ")
    locked = "material.locked_in: is not allowed beside a stress at rest; leave it out and give all in static.stress"
    assert problems(k0, bottom, GRAVITY, material=LOCKED_IN) == [locked]


WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
BREAKS = GRAINS["material"] | {"law": "linearpbond", "pb_ten": 1e6}
TOUGH = GRAINS["material"] | {"law": "linearpbond"}
BOTTOM = {"type": "viscous_input", "wave_s": "pulse"}
COLUMNS = around("free_field", "left", "right")
VISCOUS = around("viscous", "left", "right")
FIXED = {"type": "fixed"}
ALL = {"left": 2, "right": 2, "bottom": 2}
ROCK = {"density": 2700.0, "p_wave_speed": 3e3, "s_wave_speed": 2e3}


def case_of(boundary: dict, static: dict | None = None, **tables: object) -> DiskCase:
    static = {"boundary": around("roller", "left", "right") | {"bottom": FIXED}} if static is None else static
    return small(GRAINS | {"material": BREAKS, "load": [WEIGHT], "static": static, "boundary": boundary, **tables})


@pytest.mark.parametrize(
    ("boundary", "expected"),
    [
        (COLUMNS | {"bottom": BOTTOM}, ALL),
        ({"bottom": BOTTOM | {"intact": 3}, "left": {"type": "viscous", "intact": 0}}, {"bottom": 3}),
        # other rock below belongs to the problem, but the ground stands on it
        ({"bottom": BOTTOM | {"rock": ROCK}}, {"bottom": 2}),
        # a base that shakes the ground; a platen that presses on a sample
        (COLUMNS | {"bottom": {"type": "velocity", "wave_s": "pulse"}}, ALL),
        ({"bottom": FIXED, "top": {"type": "velocity", "wave_p": "pulse", "hold": ["normal"]}}, {}),
        # a side that says it is artificial makes the body a part of the ground, one that says it is not never counts
        ({"bottom": FIXED | {"artificial": True}}, {"bottom": 2}),
        (VISCOUS | {"bottom": FIXED | {"artificial": False}}, {"left": 2, "right": 2}),
        # jaws hold a part of a side
        ({"bottom": FIXED | {"within": [1.0, 3.0]}, "left": {"type": "viscous"}}, {"left": 2}),
    ],
)
def test_zones_lie_where_forces_at_rest_act_on_sides_that_stand_for_ground(boundary, expected) -> None:
    assert case_of(boundary).intact == expected


def test_sides_without_forces_at_rest_or_bonds_without_strength_have_none() -> None:
    sides, resting = VISCOUS | {"bottom": BOTTOM}, {"boundary": {"bottom": FIXED}}
    assert case_of(sides, resting).intact == {"bottom": 2}
    assert case_of(sides, resting | {"k0": 0.5}).intact == ALL
    assert case_of(around("periodic", "left", "right") | {"bottom": BOTTOM}, resting).intact == {"bottom": 2}
    moving = small({key: value for key, value in GRAINS.items() if key != "static"} | {"material": BREAKS})
    assert moving.intact == {}
    assert case_of(sides, material=TOUGH).intact == {}
    assert case_of(sides, material=TOUGH, layer=[{"thickness": 2.0, "pb_coh": 1e6}, {}]).intact == ALL
    elastic = case_of(sides, material=BREAKS | {"law": "elastic"}, output={"load_factor": True})  # has load factors
    assert (elastic.intact, elastic.bearing) == (ALL, {})


@pytest.mark.parametrize(
    ("bottom", "expected"),
    [
        (BOTTOM, Bearing()),
        (BOTTOM | {"intact": 0}, None),
        (BOTTOM | {"intact": 0, "bearing": True}, Bearing()),
        (BOTTOM | {"bearing": {"alpha_n": 2.0}}, Bearing(alpha_n=2.0)),
        ({"type": "viscoelastic_input", "wave_s": "pulse", "distance": 9.0}, None),  # has springs of its own
        ({"type": "velocity", "wave_s": "pulse"}, None),
    ],
)
def test_bottoms_of_dashpots_have_springs_where_they_have_a_zone(bottom, expected) -> None:
    assert case_of(COLUMNS | {"bottom": bottom}).bearing.get("bottom") == expected


def test_free_field_sides_have_springs_where_they_have_a_zone_and_sides_without_a_column_none() -> None:
    assert case_of(COLUMNS | {"bottom": BOTTOM}).bearing.keys() == ALL.keys()
    without = {"left": {"type": "free_field", "bearing": False}, "right": {"type": "free_field", "intact": 0}}
    assert case_of(without | {"bottom": BOTTOM}).bearing.keys() == {"bottom"}
    assert case_of(VISCOUS | {"bottom": BOTTOM}).bearing.keys() == {"bottom"}


def test_keys_of_other_sides_and_of_bars_are_refused() -> None:
    right = '[boundary.right]\ntype = "viscous"\n'
    bar = 'method.type = "finite_difference"\nbar = {length = 1.0, spacing = 0.1, density = 1.0, wave_speed = 1.0}\n'
    said = "boundary.right.{}: is for {} of disks"
    assert problems_of(f"{bar}run.duration = 1.0\n{right}intact = 2") == [said.format("intact", "sides")]
    assert problems(right, "bearing = true") == [f"{said.format('bearing', 'the bottom')}, and for free-field sides"]

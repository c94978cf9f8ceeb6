"""A run in which one half of a symmetric scene is stepped gives the same record as one in which both are stepped."""

import pytest

from dembound.kinds import with_changes

FRICTION = {"fric": 0.5}
"""Contacts carry shear as bonds do, so that disks turn."""

HALF_CELLS = {"type": "viscous", "half_mass": True}
SPRINGS = {"type": "viscoelastic", "distance": 30.0}
SIDES = ("left", "right", "bottom", "top")


def case_of(lab, size=(10.0, 6.0), pattern="A", **words):
    """A square lattice, 20 × 12 disks or more; its monitors are left and right, below and above the middle lines."""
    words = {"held": (), "material": FRICTION} | words
    case = lab.case(pattern, size, wave=lab.pulse(0.01), duration=0.03, **words)
    places = [(0.1, 0.9), (0.9, 0.9), (0.8, 0.2), (0.5, 0.7), (0.3, 0.5)]
    monitors = [{"name": f"m{k}", "position": [x * size[0], y * size[1]]} for k, (x, y) in enumerate(places)]
    output = {"output.pictures": False, "output.snapshots": 2, "output.peaks": True}
    fields = {"output.stress": True, "output.contacts": True}
    return with_changes(case, {"monitor": monitors, **output, **fields})


@pytest.fixture
def assert_same(same_record, tmp_path):
    """Asserts that the record of a case is the same whether its half is stepped or all of it; `reduced` : the lines."""

    def check(case, *reduced, **words):
        assert tuple(same_record(case, "reduce.symmetry", tmp_path, **words)["reduced"]) == reduced

    return check


def half(line, part, whole, motion="a symmetric"):
    return f"symmetry: one half of {motion} scene about {line} m is stepped, {part} of {whole} disks"


def on_top(width, force=(0.0, 5e6), **words):
    """A load on the middle metre of the upper side of a scene 6 m high."""
    middle = 0.5 * width
    region = [middle - 0.5, 5.5, middle + 0.5, 6.0]
    return {"region": region, "force": list(force), "wave": "pulse"} | words


@pytest.mark.parametrize(("width", "part", "whole"), [(10.0, 120, 240), (10.5, 132, 252)])
@pytest.mark.parametrize("steady", [False, True])
def test_a_hammer_on_the_line_between_columns_and_on_a_column(lab, width, part, whole, steady, assert_same):
    boundary = dict.fromkeys(SIDES[:3], "viscous")
    load = [on_top(width)] + ([{"acceleration": [0.0, -9.81]}] if steady else [])
    assert_same(case_of(lab, (width, 6.0), boundary=boundary, load=load), half(f"x = {width / 2:g}", part, whole))


@pytest.mark.parametrize("height", [10.0, 10.5])
def test_an_upright_scene_pushed_from_a_side(lab, height, assert_same):
    load = {"region": [0.0, 0.5 * height - 0.5, 0.4, 0.5 * height + 0.5], "force": [5e6, 0.0], "wave": "pulse"}
    case = case_of(lab, (6.0, height), boundary=dict.fromkeys(SIDES[1:], "viscous"), load=[load])
    rows = int(2.0 * height)
    assert_same(case, half(f"y = {height / 2:g}", 12 * -(-rows // 2), 12 * rows))


@pytest.mark.parametrize("held", [(), ("x",), ("rotation",)])
def test_a_p_wave_from_below(lab, held, assert_same):
    boundary = {"left": "roller", "right": "roller", "bottom": {"type": "viscous_input", "wave_p": "pulse"}}
    case = with_changes(case_of(lab, held=held, boundary=boundary), {"reduce.rows": False})
    assert_same(case, half("x = 5", 120, 240))


def test_an_s_wave_from_below_is_antisymmetric(lab, assert_same):
    boundary = {"left": "viscous", "right": "viscous", "bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    expected = half("x = 5.25", 132, 252, "an antisymmetric")
    assert_same(case_of(lab, (10.5, 6.0), boundary=boundary), expected)


def test_both_ends_driven_by_one_wave(lab, assert_same):
    boundary = {side: {"type": "velocity", "wave_p": "pulse"} for side in SIDES[:2]}
    case = with_changes(case_of(lab, (10.5, 6.0), held=("y", "rotation"), boundary=boundary), {"reduce.rows": False})
    assert_same(case, half("x = 5.25", 132, 252, "an antisymmetric"), half("y = 3", 66, 132))


@pytest.mark.parametrize(("size", "first", "second"), [((10.0, 6.0), 120, 60), ((10.5, 6.5), 143, 77)])
def test_a_quarter(lab, size, first, second, assert_same):
    x, y = (0.5 * side for side in size)
    # a row on the line is left out
    down = {"region": [x - 0.6, y - 0.6, x + 0.6, y - 0.1], "force": [0.0, -2e7], "wave": "pulse"}
    up = {"region": [x - 0.6, y + 0.1, x + 0.6, y + 0.6], "force": [0.0, 2e7], "wave": "pulse"}
    lines = half(f"x = {x:g}", first, int(4 * size[0] * size[1])), half(f"y = {y:g}", second, first)
    assert_same(case_of(lab, size, boundary=dict.fromkeys(SIDES, "viscous"), load=[down, up]), *lines)


def test_half_cells_and_springs(lab, assert_same):
    boundary = {"bottom": HALF_CELLS, "top": HALF_CELLS, "left": SPRINGS, "right": SPRINGS}
    assert_same(case_of(lab, (10.5, 6.0), boundary=boundary, load=[on_top(10.5)]), half("x = 5.25", 132, 252))


def test_half_cells_across_the_line(lab, assert_same):
    boundary = {"bottom": HALF_CELLS, "top": HALF_CELLS}
    assert_same(case_of(lab, boundary=boundary, load=[on_top(10.0)]), half("x = 5", 120, 240))


@pytest.mark.parametrize("width", [10.0, 10.5])
def test_holes(lab, width, assert_same):
    middle = 0.5 * width
    hole = [
        {"name": "tunnel", "type": "circle", "centre": [middle, 3.0], "radius": 0.8},
        {"name": "left", "type": "circle", "centre": [middle - 3.0, 3.0], "radius": 0.6},
        {"name": "right", "type": "circle", "centre": [middle + 3.0, 3.0], "radius": 0.6},
    ]
    case = with_changes(case_of(lab, (width, 6.0), boundary={"bottom": "fixed"}, load=[on_top(width)]), {"hole": hole})
    part, whole = (110, 220) if width == 10.0 else (120, 232)
    assert_same(case, half(f"x = {middle:g}", part, whole))


@pytest.mark.parametrize("width", [10.0, 10.5])
def test_local_damping(lab, width, assert_same):
    case = case_of(
        lab, (width, 6.0), material=FRICTION | {"damp": 0.3}, boundary={"bottom": "viscous"}, load=[on_top(width)]
    )
    part, whole = (120, 240) if width == 10.0 else (132, 252)
    # its force jumps where a velocity changes its sign, which rounding may move by a step
    assert_same(case, half(f"x = {width / 2:g}", part, whole), accuracy=1e-7)


@pytest.mark.parametrize(("length", "part"), [(20.0, 20), (20.5, 21)])
def test_one_half_of_one_of_identical_rows(lab, length, part, assert_same):
    load = {"region": [0.5 * length - 0.6, 0.0, 0.5 * length + 0.6, 4.0], "force": [0.0, 5e6], "wave": "pulse"}
    boundary = {"left": "viscous", "right": "viscous", "bottom": "periodic", "top": "periodic"}
    case = case_of(lab, (length, 4.0), boundary=boundary, load=[load])
    number = int(2.0 * length)
    rows = f"rows: 8 identical rows are stepped as one, {number} of {8 * number} disks"
    assert_same(case, rows, half(f"x = {length / 2:g}", part, number))

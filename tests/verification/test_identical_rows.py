"""A run in which one of several identical rows is stepped gives the same record as one in which all are stepped."""

import pytest

from dembound.kinds import with_changes

INPUT_P = {"type": "viscous_input", "wave_p": "pulse"}
INPUT = {**INPUT_P, "wave_s": "pulse"}
WEIGHTLESS = {"type": "viscous", "beta_p": 0.0, "beta_s": 0.0, "half_mass": True}
"""A side of half cells on which no force acts."""

SPRINGS = {"distance": 30.0}


def case_of(lab, pattern="A", size=(20.0, 4.0), **words):
    case = lab.case(pattern, size, wave=lab.pulse(0.02), duration=0.05, **words)
    monitors = [{"name": f"m{k}", "position": [0.3 * k * side for side in size]} for k in range(4)]
    output = {"output.pictures": False, "output.snapshots": 2, "output.peaks": True}
    fields = {"output.stress": True, "output.contacts": True}
    return with_changes(case, {"monitor": monitors, **output, **fields})


@pytest.fixture
def assert_same(same_record, tmp_path):
    """Asserts that the record of a case is the same whether its rows are stepped as one or one by one."""

    def check(case, rows, **words):
        summary = same_record(case, "reduce.rows", tmp_path, **words)
        particles = summary["particles"]
        saved = f"{particles // rows:,} of {particles:,} disks"
        assert summary["reduced"] == [f"rows: {rows} identical rows are stepped as one, {saved}"]

    return check


def test_a_p_wave_in_a_square_lattice_to_the_last_bit(lab, assert_same):
    case = case_of(lab, boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"})
    assert_same(case, 8, to_the_bit=True)


def test_a_p_wave_between_free_sides_that_could_move(lab, assert_same):
    case = case_of(lab, held=(), boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"})
    assert_same(case, 8, to_the_bit=True)


def test_an_upright_bar(lab, assert_same):
    boundary = {"bottom": {"type": "velocity", "wave_p": "pulse"}, "top": "viscous"}
    assert_same(case_of(lab, size=(4.0, 20.0), held=("x",), boundary=boundary), 8, to_the_bit=True)


@pytest.mark.parametrize("size", [(20.0, 4.0), (4.0, 20.0)])
def test_p_and_s_waves_periodic_sideways(lab, size, assert_same):
    ends, sides = (("left", "right"), ("bottom", "top"))[:: 1 if size[0] > size[1] else -1]
    boundary = {ends[0]: INPUT, ends[1]: "viscous", **dict.fromkeys(sides, "periodic")}
    assert_same(case_of(lab, size=size, held=(), boundary=boundary), 8)


def test_random_bricks_periodic_sideways(lab, assert_same):
    boundary = {"left": INPUT, "right": "viscous", "bottom": "periodic", "top": "periodic"}
    assert_same(case_of(lab, "B", (20.0, 30.0), held=(), boundary=boundary), 3)


def test_half_cells_at_the_end(lab, assert_same):
    boundary = {
        "left": INPUT,
        "right": {"type": "viscous", "half_mass": True},
        "bottom": "periodic",
        "top": "periodic",
    }
    assert_same(case_of(lab, held=(), boundary=boundary), 8)


@pytest.mark.parametrize("held", [("y",), ("x",)])
@pytest.mark.parametrize("height", [1.0, 4.0])
def test_half_cells_along_the_bar(lab, height, held, assert_same):
    # the outer rows have half the mass and half the contacts, of two rows both
    waves = {"y": "wave_p", "x": "wave_s"}[held[0]]
    boundary = {
        "left": {"type": "velocity", waves: "pulse"},
        "right": "free",
        "bottom": WEIGHTLESS,
        "top": WEIGHTLESS,
    }
    assert_same(case_of(lab, size=(20.0, height), held=held, boundary=boundary), int(2.0 * height))


@pytest.mark.parametrize("height", [1.0, 4.0])
def test_dashpots_on_rows_of_half_cells(lab, height, assert_same):
    boundary = {"left": INPUT_P, "right": "viscous", "bottom": WEIGHTLESS, "top": WEIGHTLESS}
    assert_same(case_of(lab, size=(20.0, height), boundary=boundary), int(2.0 * height))


def test_springs_at_both_ends(lab, assert_same):
    boundary = {
        "left": {**INPUT_P, "type": "viscoelastic_input", **SPRINGS},
        "right": {"type": "viscoelastic", **SPRINGS},
    }
    assert_same(case_of(lab, boundary=boundary), 8)


def test_local_damping(lab, assert_same):
    boundary = {"left": INPUT, "right": "viscous", "bottom": "periodic", "top": "periodic"}
    # its force jumps where a velocity changes its sign, which rounding may move by a step
    assert_same(case_of(lab, held=(), boundary=boundary, material={"damp": 0.3}), 8, accuracy=1e-7)


@pytest.mark.parametrize("wave", ["pulse", None])
def test_loads_on_all_rows(lab, wave, assert_same):
    load = {"region": [0.0, 0.0, 0.4, 4.0], "force": [5e6, 0.0]} | ({"wave": wave} if wave else {})
    weight = {"acceleration": [9.81, 0.0]}
    boundary = {"left": "free", "right": "viscous"}
    assert_same(case_of(lab, boundary=boundary, load=[load, weight]), 8)

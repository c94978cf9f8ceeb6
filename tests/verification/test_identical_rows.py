"""A run in which one of several identical rows is stepped gives the same record as one in which all are stepped."""

import json

import h5py
import numpy as np
import pytest

from dembound.kinds import with_changes
from dembound.running import run_case

INPUT_P = {"type": "viscous_input", "wave_p": "pulse"}
INPUT = {**INPUT_P, "wave_s": "pulse"}
WEIGHTLESS = {"type": "viscous", "beta_p": 0.0, "beta_s": 0.0, "half_mass": True}
"""A side of half cells on which no force acts."""

SPRINGS = {"distance": 30.0}

EPS = np.finfo(float).eps


def case_of(lab, pattern="A", size=(20.0, 4.0), **words):
    case = lab.case(pattern, size, wave=lab.pulse(0.02), duration=0.05, **words)
    monitors = [{"name": f"m{k}", "position": [0.3 * k * side for side in size]} for k in range(4)]
    output = {"output.pictures": False, "output.snapshots": 2, "output.stress": True, "output.peaks": True}
    return with_changes(case, {"monitor": monitors, **output})


def runs(case, folder):
    """The records and summaries of the case with its rows stepped as one, and one by one."""
    for rows in (True, False):
        done = run_case(with_changes(case, {"reduce.rows": rows}), folder / str(rows))
        with h5py.File(done / "run.h5") as file:
            names: list[str] = []
            file.visit(names.append)
            data = {name: file[name][()] for name in names if isinstance(file[name], h5py.Dataset)}
        yield data, json.loads((done / "summary.json").read_text())


def assert_same(case, folder, rows, *, to_the_bit=False, accuracy=None):
    """Both records agree, energies within 1e-12; accuracy : of all relative to the largest, None: that of rounding."""
    (data, summary), (expected, of_all) = runs(case, folder)

    particles = of_all["particles"]
    saved = f"{particles // rows:,} of {particles:,} disks"
    assert summary["reduced"] == [f"rows: {rows} identical rows are stepped as one, {saved}"]
    assert of_all["reduced"] == []
    assert (summary["time_step"], summary["particles"]) == (of_all["time_step"], particles)
    assert set(data) == set(expected)

    def largest(end):
        return max(np.abs(values).max(initial=0.0) for name, values in expected.items() if name.endswith(end))

    # sums in another order differ by the rounding of displacements, a few ε·u/Δt of velocity per step
    jitter = 8.0 * EPS * largest("displacement") / of_all["time_step"] * of_all["steps"]
    relative = accuracy or jitter / largest("velocity")
    assert largest("velocity") > 0.1  # the pulse did run
    assert relative < 1e-6
    for name, values in expected.items():
        group, quantity = name.split("/")[0], name.split("/")[-1]
        if values.dtype.kind != "f" or (to_the_bit and group in ("histories", "snapshots", "boundaries")):
            np.testing.assert_array_equal(data[name], values, err_msg=name)
        elif group == "energy":
            bound = (accuracy or 1e-12) * largest("energy/kinetic")
            np.testing.assert_allclose(data[name], values, rtol=0.0, atol=bound, err_msg=name)
        else:
            bound = relative * largest({"peak_velocity": "velocity"}.get(quantity, quantity))
            np.testing.assert_allclose(data[name], values, rtol=0.0, atol=bound, err_msg=name)


def test_a_p_wave_in_a_square_lattice_to_the_last_bit(lab, tmp_path):
    case = case_of(lab, boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"})
    assert_same(case, tmp_path, 8, to_the_bit=True)


def test_a_p_wave_between_free_sides_that_could_move(lab, tmp_path):
    case = case_of(lab, held=(), boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"})
    assert_same(case, tmp_path, 8, to_the_bit=True)


def test_an_upright_bar(lab, tmp_path):
    boundary = {"bottom": {"type": "velocity", "wave_p": "pulse"}, "top": "viscous"}
    assert_same(case_of(lab, size=(4.0, 20.0), held=("x",), boundary=boundary), tmp_path, 8, to_the_bit=True)


@pytest.mark.parametrize("size", [(20.0, 4.0), (4.0, 20.0)])
def test_p_and_s_waves_periodic_sideways(lab, size, tmp_path):
    ends, sides = (("left", "right"), ("bottom", "top"))[:: 1 if size[0] > size[1] else -1]
    boundary = {ends[0]: INPUT, ends[1]: "viscous", **dict.fromkeys(sides, "periodic")}
    assert_same(case_of(lab, size=size, held=(), boundary=boundary), tmp_path, 8)


def test_random_bricks_periodic_sideways(lab, tmp_path):
    boundary = {"left": INPUT, "right": "viscous", "bottom": "periodic", "top": "periodic"}
    assert_same(case_of(lab, "B", (20.0, 30.0), held=(), boundary=boundary), tmp_path, 3)


def test_half_cells_at_the_end(lab, tmp_path):
    boundary = {
        "left": INPUT,
        "right": {"type": "viscous", "half_mass": True},
        "bottom": "periodic",
        "top": "periodic",
    }
    assert_same(case_of(lab, held=(), boundary=boundary), tmp_path, 8)


@pytest.mark.parametrize("held", [("y",), ("x",)])
@pytest.mark.parametrize("height", [1.0, 4.0])
def test_half_cells_along_the_bar(lab, height, held, tmp_path):
    # the outer rows have half the mass and half the contacts, of two rows both
    waves = {"y": "wave_p", "x": "wave_s"}[held[0]]
    boundary = {
        "left": {"type": "velocity", waves: "pulse"},
        "right": "free",
        "bottom": WEIGHTLESS,
        "top": WEIGHTLESS,
    }
    assert_same(case_of(lab, size=(20.0, height), held=held, boundary=boundary), tmp_path, int(2.0 * height))


def test_dashpots_on_two_rows_of_half_cells(lab, tmp_path):
    boundary = {"left": INPUT_P, "right": "viscous", "bottom": WEIGHTLESS, "top": WEIGHTLESS}
    assert_same(case_of(lab, size=(20.0, 1.0), boundary=boundary), tmp_path, 2)


def test_springs_at_both_ends(lab, tmp_path):
    boundary = {
        "left": {**INPUT_P, "type": "viscoelastic_input", **SPRINGS},
        "right": {"type": "viscoelastic", **SPRINGS},
    }
    assert_same(case_of(lab, boundary=boundary), tmp_path, 8)


def test_local_damping(lab, tmp_path):
    boundary = {"left": INPUT, "right": "viscous", "bottom": "periodic", "top": "periodic"}
    # its force jumps where a velocity changes its sign, which rounding may move by a step
    assert_same(case_of(lab, held=(), boundary=boundary, material={"damp": 0.3}), tmp_path, 8, accuracy=1e-7)


@pytest.mark.parametrize("wave", ["pulse", None])
def test_loads_on_all_rows(lab, wave, tmp_path):
    load = {"region": [0.0, 0.0, 0.4, 4.0], "force": [5e6, 0.0]} | ({"wave": wave} if wave else {})
    weight = {"acceleration": [9.81, 0.0]}
    boundary = {"left": "free", "right": "viscous"}
    assert_same(case_of(lab, boundary=boundary, load=[load, weight]), tmp_path, 8)

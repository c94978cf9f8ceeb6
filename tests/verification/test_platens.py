"""Tests to failure of small samples: platens, jaws, membranes, and the end past the peak."""

import json

import h5py
import numpy as np
import pytest
from small_cases import GRAINS, small
from warned_cases import warned

from dembound.results.histories import read_side_history
from dembound.running import run_case

WIDTH, HEIGHT = 4.0, 8.0
CELL = 0.4e6
"""Confining pressure, Pa."""

BEGIN = 0.02
"""Time at which the platens begin to move, s."""

PRESS = {"type": "constant", "amplitude": -0.1, "rise": 0.005, "start": BEGIN}
SMOOTH = {"type": "velocity", "wave_p": "press", "hold": ["normal"]}
ROLLER = {"type": "roller", "artificial": False}
SAMPLE = {
    "packing": GRAINS["packing"] | {"size": [WIDTH, HEIGHT]},
    "material": GRAINS["material"]
    | {"law": "linearpbond", "pb_ten": 1e6, "pb_coh": 1e6, "fric": 0.5, "contact_share": 0.2, "damp": 0.7},
    "boundary": {"top": SMOOTH, "bottom": ROLLER},
    "wave": {"press": PRESS},
    "run": {"duration": 1.0, "until": "peak"},
    "monitor": [{"name": "middle", "position": [2.0, 4.0]}],
    "output": {"pictures": False, "history_interval": 4e-4, "side_interval": 4e-4},
}
"""A sample of 8 × 16 diameters between smooth platens."""

JAW = {"within": [1.2, 2.8]}
JAWS = {"top": SMOOTH | {"hold": ["normal", "shear"]} | JAW, "bottom": {"type": "fixed"} | JAW}
TESTS = {
    "ucs": SAMPLE,
    "tension": SAMPLE
    | {
        "boundary": {"top": {"type": "velocity", "wave_p": "press"}, "bottom": {"type": "fixed", "artificial": False}},
        "wave": {"press": PRESS | {"amplitude": 0.05}},
    },
    "brazilian": SAMPLE
    | {
        "packing": GRAINS["packing"] | {"size": [4.0, 4.0]},
        "hole": [{"name": "sample", "type": "circle", "centre": [2.0, 2.0], "radius": 2.0, "keep": "inside"}],
        "boundary": JAWS,
        "monitor": [{"name": "middle", "position": [2.0, 2.0]}],
    },
    "biaxial": SAMPLE
    | {
        "load": [{"name": "cell", "pressure": CELL, "sides": ["left", "right", "top"]}],
        "static": {"boundary": {"bottom": {"type": "roller"}}},
    },
}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Summary and record of each test by name."""
    folder = tmp_path_factory.mktemp("tests")
    done = {name: run_case(small(tables, name), folder) for name, tables in TESTS.items()}
    return {name: (json.loads((each / "summary.json").read_text()), each / "run.h5") for name, each in done.items()}


def force(record, side: str) -> np.ndarray:
    """Forces (k, 2) N on a side."""
    with h5py.File(record) as file:
        found: np.ndarray = file[f"boundaries/{side}/force"][:]
        return found


@pytest.mark.parametrize("name", TESTS)
def test_a_test_ends_past_its_peak_with_its_energy_accounted_for(results, name) -> None:
    summary, record = results[name]
    top = read_side_history(record, "top")
    added = np.abs(force(record, "top")[:, 1] - force(record, "top")[0, 1])
    wave = small(TESTS[name]).wave["press"]

    assert summary["ended"]["why"] == "peak"
    assert summary["cracks"]["tension"] > 10
    assert added[-1] < 0.7 * added.max()
    assert added.argmax() < len(added) - 10
    assert summary["energy"]["relative_error"] < 1e-5
    assert not summary["warnings"]
    # the platen has moved as its wave says, and its work is what came in
    assert top.displacement[-1, 1] == pytest.approx(wave.displacement(top.time[-1:])[0], rel=1e-3)
    until = top.time <= summary["energy"]["time"]
    work = np.trapezoid(force(record, "top")[until, 1], top.displacement[until, 1])
    assert summary["sides"]["top"]["came_in"] + summary["energy"]["balance"] == pytest.approx(work, rel=0.02)


def test_a_smooth_platen_lets_its_disks_slide_and_a_grip_does_not(results) -> None:
    assert not force(results["ucs"][1], "top")[:, 0].any()
    assert np.abs(force(results["tension"][1], "top")[:, 0]).max() > 1e4
    assert read_side_history(results["ucs"][1], "top").displacement[-1, 0] != 0.0
    assert read_side_history(results["tension"][1], "top").displacement[-1, 0] == 0.0
    assert force(results["tension"][1], "top")[:, 1].max() > 0.0
    assert results["tension"][0]["cracks"]["shear"] == 0


def test_the_shape_of_a_sample_is_what_remains(results) -> None:
    with h5py.File(results["brazilian"][1]) as file:
        away = np.hypot(*(file["particles/position"][:] - 2.0).T)
        top = file["boundaries/top/particle"][:]
        across = file["particles/position"][:][top, 0]
    assert 45 < len(away) < 60  # of the same solid fraction as 71 in the brick
    assert away.max() <= 2.0
    assert (np.abs(across - 2.0) > 0.8).any()  # beyond the jaw the side is free


def test_a_confined_sample_rests_until_its_platens_move_and_is_stronger(results) -> None:
    _, record = results["biaxial"]
    with h5py.File(record) as file:
        history = file["histories/middle"]
        before = history["time"][:] < BEGIN
        assert np.abs(history["velocity"][:][before]).max() < 1e-12
    begin, peak = force(record, "top")[0, 1], np.abs(force(record, "top")[:, 1]).max()

    assert begin == pytest.approx(-CELL * WIDTH, rel=1e-3)
    unconfined = np.abs(force(results["ucs"][1], "top")[:, 1]).max()
    assert peak > unconfined + CELL * WIDTH  # friction carries more than the pressure alone


def test_a_flat_side_that_holds_a_round_face_is_warned_of() -> None:
    whole = {side: {key: value for key, value in table.items() if key != "within"} for side, table in JAWS.items()}
    warnings = warned(small(TESTS["brazilian"] | {"boundary": whole}))

    assert len(warnings) == 2
    assert all("is flat, but holds" in line for line in warnings)
    assert warned(small(TESTS["brazilian"])) == warned(small(SAMPLE)) == []

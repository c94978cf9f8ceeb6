"""One case from tables to a folder of results."""

import json

import h5py
import numpy as np
import pytest

from dembound.case import Case
from dembound.errors import CaseError, RunError
from dembound.run import arrival, describe_packing, plan, run_case
from dembound.scene import build

GRIP = {"type": "velocity", "wave_p": "pulse"}
BLOW_UP = {"boundary.left": GRIP, "wave.pulse.amplitude": 1e305}
"""A motion so large that forces overflow."""


def no_numbers_but_finite(constant: str) -> None:
    raise AssertionError(f"{constant} is not JSON")


def summary(folder) -> dict:
    return json.loads((folder / "summary.json").read_text(), parse_constant=no_numbers_but_finite)


def test_the_number_of_steps_covers_the_duration(bar) -> None:
    planned = plan(bar())

    assert (planned.steps - 1) * planned.time_step < 0.01 <= planned.steps * planned.time_step
    assert plan(bar({"run.time_step": 1e-4})).steps == 100


def test_a_step_above_the_limit_is_refused_before_anything_is_written(bar, tmp_path) -> None:
    with pytest.raises(CaseError, match=r"run\.time_step"):
        run_case(bar({"run.time_step": 5e-3}), tmp_path)

    assert not list(tmp_path.iterdir())


def test_a_run_leaves_one_whole_folder(bar, tmp_path) -> None:
    folder = run_case(bar({"output.pictures": True}), tmp_path / "new" / "results")

    assert folder == tmp_path / "new" / "results" / "bar"
    assert list(folder.parent.iterdir()) == [folder]
    names = {path.name for path in folder.iterdir()}
    assert names == {"run.h5", "summary.json", "paraview", "scene.png", "histories.png"}
    with h5py.File(folder / "run.h5") as file:
        assert file.attrs["complete"]


def test_pictures_are_drawn_only_where_they_are_wanted(bar, tmp_path) -> None:
    without = run_case(bar(), tmp_path)
    unwatched = run_case(bar({"output.pictures": True, "monitor": []}, "unwatched"), tmp_path)

    assert not list(without.glob("*.png"))
    assert [path.name for path in unwatched.glob("*.png")] == ["scene.png"]


def test_snapshots_are_evenly_spaced_and_the_last_is_at_the_end(bar, tmp_path) -> None:
    folder = run_case(bar({"output.snapshots": 4, "run.time_step": 2.5e-4}), tmp_path)

    with h5py.File(folder / "run.h5") as file:
        times = [group.attrs["time"] for group in file["snapshots"].values()]
    np.testing.assert_allclose(times, [0.0025, 0.005, 0.0075, 0.01], rtol=1e-12)


def test_the_last_state_is_kept_even_without_snapshots(bar, tmp_path) -> None:
    folder = run_case(bar({"output.snapshots": 0}), tmp_path)

    with h5py.File(folder / "run.h5") as file:
        (last,) = file["snapshots"].values()
        assert last.attrs["time"] == pytest.approx(summary(folder)["duration"], rel=1e-15)


def test_the_summary_is_plain_json_with_the_run_in_numbers(bar, tmp_path) -> None:
    found = summary(run_case(bar({"run.duration": 0.03}), tmp_path))

    assert set(found) == {
        *(
            "name",
            "title",
            "version",
            "particles",
            "contacts",
            "loose_disks_left_out",
            "time_step",
            "step_limit",
            "steps",
            "duration",
        ),
        *("wall_time", "threads", "particle_steps_per_second", "memory_bytes", "packing", "boundaries", "monitors"),
        "reduced",
    }
    assert (found["name"], found["particles"], found["contacts"]) == ("bar", 40, 2 * 19 + 20)
    assert found["duration"] == pytest.approx(found["steps"] * found["time_step"], rel=1e-15)
    assert found["particle_steps_per_second"] == pytest.approx(40 * found["steps"] / found["wall_time"])
    # by hand: ρc_p² shared by contact and bond; rounding and a solve with one unknown
    assert found["packing"]["C11"] == pytest.approx(2.5e9, rel=1e-12)
    assert found["packing"]["C66"] == pytest.approx(0.625e9, rel=1e-12)
    assert found["packing"]["p_wave_speed"] == pytest.approx(1000.0, rel=1e-12)
    assert found["packing"]["s_wave_speed"] is None


def test_the_summary_describes_the_sides(bar, tmp_path) -> None:
    sides = summary(run_case(bar({"run.duration": 0.03, "boundary.right.beta_p": 0.9}), tmp_path))["boundaries"]

    assert {side: described["type"] for side, described in sides.items()} == {
        "left": "viscous_input",
        "right": "viscous",
        "bottom": "free",
        "top": "free",
    }
    right = sides["right"]
    assert (right["particles"], right["length"], right["cover"]) == (2, 1.0, 1.0)
    assert (right["beta_p"], right["beta_s"]) == (0.9, 1.0)
    assert "beta_p" not in sides["top"]
    assert right["peak_velocity"][0] > 0.4  # of a pulse of 0.5 m/s
    assert right["peak_velocity"][1] == 0.0
    assert right["peak_velocity_deviation"][0] < 1e-12  # both disks of the bar's end move alike


def test_the_summary_tells_when_the_wave_came(bar, tmp_path) -> None:
    found = summary(run_case(bar({"run.duration": 0.03}), tmp_path))
    middle = found["monitors"]["middle"]

    assert middle["component"] == "x"
    x = middle["position"][0]
    # half the crest at T/4 and the crest at T/2 after the front, which travels at 1000 m/s. 20 disks per wavelength
    # delay a wave by (qa)²/24 = 0.4 % of its way, its shorter parts by more; one step is 0.36 ms
    assert middle["arrival"] == pytest.approx(0.0025 + x / 1000.0, abs=5e-4)
    assert middle["peak_time"] == pytest.approx(0.005 + x / 1000.0, abs=5e-4)
    assert middle["peak_velocity"] == pytest.approx(0.5, rel=0.05)


def test_the_packing_is_described_where_a_motion_is_held(bar) -> None:
    described = describe_packing(build(bar({"motion.held": ["y", "rotation"]})))

    assert described["p_wave_speed"] == pytest.approx(1000.0, rel=1e-12)
    assert described["s_wave_speed"] is None


def test_progress_is_told_after_every_block(bar, tmp_path) -> None:
    seen = []
    run_case(bar({"run.duration": 0.2}), tmp_path, lambda simulation, steps: seen.append((simulation.steps, steps)))

    assert seen[0] == (256, seen[-1][0])
    assert seen[-1][0] == seen[-1][1]


def test_a_run_that_fails_leaves_a_partial_folder_with_what_there_was(bar, tmp_path) -> None:
    with pytest.raises(RunError, match="grew without bound"):
        run_case(bar(BLOW_UP), tmp_path)

    assert [path.name for path in tmp_path.iterdir()] == ["bar.partial"]
    with h5py.File(tmp_path / "bar.partial" / "run.h5") as file:
        assert not file.attrs["complete"]


def finished_then_failed(bar, tmp_path) -> Case:
    run_case(bar(), tmp_path)
    with pytest.raises(RunError):
        run_case(bar(BLOW_UP), tmp_path)
    return bar()


def test_earlier_results_outlive_a_run_that_fails(bar, tmp_path) -> None:
    finished_then_failed(bar, tmp_path)

    assert sorted(path.name for path in tmp_path.iterdir()) == ["bar", "bar.partial"]
    assert summary(tmp_path / "bar")["steps"] == 29


def test_a_new_run_takes_the_place_of_what_earlier_ones_left(bar, tmp_path) -> None:
    case = finished_then_failed(bar, tmp_path)
    (tmp_path / "bar" / "scene.png").write_text("old")
    run_case(case, tmp_path)

    assert [path.name for path in tmp_path.iterdir()] == ["bar"]
    assert not (tmp_path / "bar" / "scene.png").exists()


def test_the_same_case_gives_the_same_bits(bar, tmp_path) -> None:
    histories = []
    for name in ("one", "other"):
        with h5py.File(run_case(bar(name=name), tmp_path) / "run.h5") as file:
            histories.append(file["histories/middle/velocity"][:])

    assert np.array_equal(*histories)


TIME = np.arange(5.0)


def test_arrival_is_where_half_the_peak_is_passed_between_two_samples() -> None:
    velocity = np.column_stack([[0.0, 1.0, 4.0, 1.0, 0.0], np.zeros(5)])

    # half of 4 lies a third of the way from 1 to 4
    assert arrival(TIME, velocity) == {
        "component": "x",
        "peak_velocity": 4.0,
        "peak_time": 2.0,
        "arrival": pytest.approx(4.0 / 3.0, rel=1e-15),
    }


def test_arrival_takes_the_component_that_moves_most_and_keeps_its_sign() -> None:
    velocity = np.column_stack([np.full(5, 0.1), [0.0, 0.0, -2.0, 0.0, 1.5]])

    assert arrival(TIME, velocity) == {"component": "y", "peak_velocity": -2.0, "peak_time": 2.0, "arrival": 1.5}


def test_a_motion_that_is_there_from_the_start_arrives_then() -> None:
    assert arrival(TIME, np.ones((5, 2)))["arrival"] == 0.0


def test_nothing_arrives_at_rest() -> None:
    assert arrival(TIME, np.zeros((5, 2))) == {
        "component": "x",
        "peak_velocity": 0.0,
        "peak_time": None,
        "arrival": None,
    }

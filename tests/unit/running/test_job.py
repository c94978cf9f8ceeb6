"""Runs of one case from tables to a folder of results."""

import json
import time

import h5py
import numpy as np
import pytest
from readable import drawn_quickly

from dembound.errors import CaseError, RunError
from dembound.motion.trackers import Run
from dembound.results.folder import OWN
from dembound.running import SECTIONS, Progress, plan, preflight, run_case

GRIP = {"type": "velocity", "wave_p": "pulse"}
BLOW_UP = {"boundary.left": GRIP, "run.duration": 0.05}
"""Changes that, with the fixture `unstable`, run so long that the motion passes every bound."""

HANGING = {
    "material.damp": 0.0,
    "wave.pulse.start": 1.0,
    "boundary.left": {"type": "fixed"},
    "boundary.right": {"type": "free"},
    "load": [{"name": "weight", "acceleration": [9.81, 0.0]}],
    "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}},
}
"""The bar hangs from its left end while it settles and after."""


def no_numbers_but_finite(constant: str) -> None:
    raise AssertionError(f"{constant} is not JSON")


def summary(folder) -> dict:
    return json.loads((folder / "summary.json").read_text(), parse_constant=no_numbers_but_finite)


def test_the_number_of_steps_covers_the_duration(bar) -> None:
    planned = plan(bar())

    assert (planned.steps - 1) * planned.time_step < 0.01 <= planned.steps * planned.time_step
    assert plan(bar({"run.time_step": 1e-4})).steps == 100


@pytest.fixture(autouse=True)
def _small_pictures(monkeypatch) -> None:
    drawn_quickly(monkeypatch)


def test_every_file_of_a_run_is_one_of_those_that_a_rerun_replaces(bar, spalling, tmp_path) -> None:
    pulled = {"boundary.left": GRIP, "wave.pulse.amplitude": -5.0}
    brittle = {"material.law": "linearpbond", "material.pb_ten": 1e6, **pulled}
    output = {"pictures": True, "snapshots": 2, "stress": True, "contacts": True, "peaks": True, "paraview": "both"}
    every = {f"output.{key}": value for key, value in output.items()}
    cases = bar({**brittle, **every}, "brittle"), bar({**HANGING, **every}, "hanging"), spalling({**every})
    found = set()
    for case in cases:
        folder = run_case(case, tmp_path)
        names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
        assert [name for name in names if not OWN.fullmatch(name)] == []
        assert ("paraview/contacts.pvd" in names) == ("paraview/bar.pvd" not in names)  # a bar has no contacts
        found |= names

    of_each = [f"paraview/{name}" for name in ("particles", "contacts", "bar")]
    assert found >= {f"{name}{ending}" for name in of_each for ending in ("_0000.vtu", "_0001.vtu", ".pvd", ".vtkhdf")}
    assert found >= {"paraview/cracks.vtu", "checkpoint.npz", "settled/body.npz"}
    assert found >= {"scene.png", "histories.png", "histories_stress.png"}
    assert OWN.fullmatch("settled/before.right_column.npz")  # of ground of two heights
    for name in ("notes.txt", "paraview/mine_0000.vtu", "paraview/state.pvsm", "other/run.h5", "run.h5.bak"):
        assert not OWN.fullmatch(name)


KEYS = """name title version particles contacts loose_disks_left_out time_step step_limit steps duration ended
wall_time seconds layers has_history threads particle_steps_per_second memory_bytes packing load_factor far
forces_at_rest boundaries turns joints monitors laws static cracks energy keys reduced not_reduced resumed sides
warnings waves debris"""


def test_the_summary_is_plain_json_with_the_run_in_numbers(bar, tmp_path) -> None:
    began = time.perf_counter()
    case = bar({"run.duration": 0.03, "boundary.right.beta_p": 0.9})
    folder = run_case(case, tmp_path, seconds={"import": 1000.0})
    took = time.perf_counter() - began
    found = summary(folder)

    assert set(found) == set(KEYS.split())
    assert found["duration"] == pytest.approx(found["steps"] * found["time_step"], rel=1e-15)
    assert found["reduced"] == ["rows: 2 identical rows are stepped as one, 20 of 40 disks"]
    assert found["particle_steps_per_second"] == pytest.approx(20 * found["steps"] / found["seconds"]["step"])
    # by hand: ρc_p² shared by contact and bond; rounding and a solve with one unknown
    assert found["packing"]["C11"] == pytest.approx(2.5e9, rel=1e-12)
    assert found["packing"]["p_wave_speed"] == pytest.approx(1000.0, rel=1e-12)
    # the books close to rounding: some 80 steps of sums over 40 particles of 1.1e-16 each
    assert found["energy"]["relative_error"] < 1e-12
    assert found["energy"]["outside"] != 0.0

    seconds = found["seconds"]
    assert tuple(seconds) == SECTIONS
    assert found["wall_time"] == pytest.approx(sum(seconds.values()), rel=1e-12)
    assert seconds.pop("import") == 1000.0
    # what is left out is the summary itself, and folders that are made and renamed
    assert 0.0 < sum(seconds.values()) <= took

    right = found["boundaries"]["right"]
    assert right["peak_velocity"][0] > 0.4  # of a pulse of 0.5 m/s
    assert right["peak_velocity_deviation"][0] < 1e-12  # both disks of the bar's end move alike

    middle = found["monitors"]["middle"]
    x = middle["position"][0]
    # half the crest at T/4 and the crest at T/2 after the front, which travels at 1000 m/s. 20 disks per wavelength
    # delay a wave by (qa)²/24 = 0.4 % of its way, its shorter parts by more; one step is 0.36 ms
    assert middle["arrival"] == pytest.approx(0.0025 + x / 1000.0, abs=5e-4)
    assert middle["peak_time"] == pytest.approx(0.005 + x / 1000.0, abs=5e-4)
    assert middle["peak_velocity"] == pytest.approx(0.5, rel=0.05)

    with h5py.File(folder / "run.h5") as one, h5py.File(run_case(case, tmp_path / "other") / "run.h5") as other:
        name = "histories/middle/velocity"
        assert np.array_equal(one[name], other[name])  # the same case gives the same bits


class Heard(Progress):
    """Writes down all reports."""

    def __init__(self) -> None:
        self.static: list[tuple[int, float]] = []
        self.blocks: list[tuple[int, int]] = []
        self.warnings: list[tuple[str, int]] = []

    def warned(self, message: str) -> None:
        self.warnings.append((message.split(":")[0], len(self.blocks)))

    def settling(self, steps: int, ratio: float, stage: str) -> None:
        self.static.append((steps, ratio))

    def running(self, run: Run, steps: int) -> None:
        self.blocks.append((run.state.step, steps))


def test_warnings_are_reported_before_and_after_the_run_and_kept_and_progress_after_every_block(bar, tmp_path) -> None:
    heard = Heard()
    burst = {"type": "sine_burst", "amplitude": 0.5, "frequency": 100.0, "cycles": 4}
    folder = run_case(bar({"wave.pulse": burst, "run.duration": 0.03}), tmp_path, heard)

    # four cycles of 10 m, for which disks of 0.5 m are coarse; the run sees three
    (short, before), (moving, after) = heard.warnings
    assert (short, before) == ("wave.pulse", 0)
    assert (moving, after) == ("monitor.middle", len(heard.blocks))
    assert [warning.split(":")[0] for warning in summary(folder)["warnings"]] == [short, moving]

    heard = Heard()
    long = run_case(bar({"run.duration": 0.4, "wave.pulse.period": 0.07}), tmp_path, heard)
    assert summary(long)["warnings"] == []
    done = [steps for steps, _ in heard.blocks]
    (total,) = {of for _, of in heard.blocks}
    assert done == sorted(done)
    assert done[-1] == total > 256
    assert np.diff([0, *done]).max() <= 256


def test_what_would_stop_a_case_is_foreseen_and_nothing_is_written(bar, spalling, tmp_path) -> None:
    for stopped, said in (
        (bar({"run.time_step": 5e-3}), r"run\.time_step"),
        (spalling({"run.courant": 2.0}), r"run\.courant: is 2, must not be above 1\.96"),
        (bar({"run.duration": 1e9, "run.time_step": 1e-12}), r"run\.duration: takes .* must take no more than"),
    ):
        for act in (preflight, lambda case: run_case(case, tmp_path)):
            with pytest.raises(CaseError, match=said) as caught:
                act(stopped)
            assert caught.value.source == stopped.name
    preflight(bar())
    preflight(spalling())
    beside = {"name": "push", "force": [1.0, 0.0], "region": [3.01, 0.3, 3.02, 0.31]}
    for load in (beside, {**beside, "wave": "pulse"}):
        with pytest.raises(CaseError, match="no particle is centred"):
            run_case(bar({"load": [load]}), tmp_path)
    assert not list(tmp_path.iterdir())


def test_energies_are_entered_a_hundred_times_or_as_often_as_asked_and_snapshots_evenly(bar, tmp_path) -> None:
    usual = {"run.time_step": 1e-4, "run.duration": 0.025, "output.snapshots": 4}
    for name, changes, expected in (
        ("usual", {}, [*np.arange(0.0, 250.0, 2.0), 249.0]),  # and at the last step
        ("asked", {"output.energy_interval": 1e-3}, [*np.arange(0.0, 250.0, 10.0), 249.0]),
    ):
        with h5py.File(run_case(bar({**usual, **changes}, name), tmp_path) / "run.h5") as file:
            # ten times a step of 1e-4 s, each product rounded
            np.testing.assert_allclose(file["energy/time"], 1e-4 * np.array(expected), rtol=1e-15)
            times = [group.attrs["time"] for group in file["snapshots"].values()]
    np.testing.assert_allclose(times, [0.0062, 0.0125, 0.0187, 0.025], rtol=1e-12)


NICHE = {"name": "niche", "type": "rectangle", "corners": [6.0, 0.5, 8.0, 1.1], "stage": "after"}
"""Four disks of the upper row."""


def test_static_stages_are_run_first_and_recorded(bar, tmp_path) -> None:
    heard = Heard()
    folder = run_case(bar({**HANGING, "hole": [NICHE]}), tmp_path, heard)

    static = summary(folder)["static"]
    before = static["before"]
    assert heard.static[-1] == (static["steps"], static["ratio"])
    assert (before["steps"], before["ratio"]) in heard.static
    assert max(before["ratio"], static["ratio"]) <= 1e-6 < heard.static[0][1]
    # disks of 625 kg hang from two; the mean of their weights and of what is left is what the record says
    for stage, disks in ((before, 40), (static, 36)):
        assert stage["mean_reaction"] == pytest.approx(disks * 625.0 * 9.81 / 2, rel=1e-4)
    with h5py.File(folder / "run.h5") as file:
        x, y = file["particles/position"][:].T
        assert not ((x > 6.0) & (x < 8.0) & (y > 0.5)).any()
        first, last = (file[f"{stage}/displacement"][:, 0] for stage in ("static/before", "static"))
        # with four weights less to carry, the bar springs back where only that has changed
        assert np.all(last[(x > 0.5) & (x < 5.5)] < first[(x > 0.5) & (x < 5.5)])
        # histories and snapshots count from where the stages ended
        assert np.abs(file["snapshots/0000/displacement"][:, 0]).max() < 1e-6 * last.max()


def test_cracks_before_an_excavation_are_recorded_where_they_were(bar, tmp_path) -> None:
    weak = {"material.law": "linearpbond", "material.pb_ten": 0.3 * 19 * 625.0 * 9.81 / 0.5}
    held = {"boundary.right": {"type": "fixed"}, "static.boundary.right": {"type": "fixed"}}
    near = {**NICHE, "corners": [1.0, 0.5, 2.0, 1.1]}
    folder = run_case(bar({**HANGING, **held, **weak, "hole": [near]}), tmp_path)

    found = summary(folder)
    assert found["static"]["before"]["cracks"] > 0
    with h5py.File(folder / "run.h5") as file:
        cracks, places = file["cracks"], file["particles/position"][:]
        assert len(cracks["time"]) == found["cracks"]["tension"] > 0
        # bonds of 0.5 m along x, whose disks have moved by strains of 1e-4 of the bar
        middle = places[cracks["particles"][:]].mean(axis=1)
        np.testing.assert_allclose(cracks["position"][:], middle, rtol=0.0, atol=1e-3)
        apart = np.diff(places[cracks["particles"][:]], axis=1)[:, 0]
        np.testing.assert_allclose(np.hypot(*apart.T), 0.5, rtol=1e-12)


def test_a_static_stage_that_fails_does_not_stand_in_the_way_of_the_next_run(bar, tmp_path) -> None:
    with pytest.raises(RunError, match="static stage") as caught:
        run_case(bar({**HANGING, "static.ratio": 1e-12, "static.max_steps": 1}), tmp_path)
    assert caught.value.source == "bar"
    assert str(caught.value).endswith(f"\nto see it: dembound plot {tmp_path / 'bar.partial'} --field unbalanced")
    # the state it reached is kept to be looked at
    with h5py.File(tmp_path / "bar.partial" / "run.h5") as file:
        assert not file.attrs["complete"]
        (snapshot,) = file["snapshots"].values()
        assert snapshot["unbalanced"].shape == (len(file["particles/radius"]), 2)
        assert np.abs(snapshot["unbalanced"][:]).max() > 0.0

    run_case(bar(HANGING), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["bar"]


def test_a_run_that_fails_leaves_what_there_was_beside_earlier_results(bar, tmp_path, unstable) -> None:
    run_case(bar(), tmp_path)
    with unstable(), pytest.raises(RunError, match="without bound: at t = "):
        run_case(bar(BLOW_UP), tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bar", "bar.partial"]
    assert summary(tmp_path / "bar")["steps"] == 29
    with h5py.File(tmp_path / "bar.partial" / "run.h5") as file:
        assert not file.attrs["complete"]

    # a new run takes the place of both
    run_case(bar(), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["bar"]


QUIET = {"run.duration": 0.2, "run.time_step": 2.5e-4, "output.snapshots": 8}
"""The pulse is over at 0.01 s, and has left the bar of 10 m at 0.02 s but for what the coarse lattice leaves behind."""

SILENT = {"run.until": "silent", "run.silent_level": 0.05}


def data_of(folder) -> dict[str, np.ndarray]:
    with h5py.File(folder / "run.h5") as file:
        names: list[str] = []
        file.visit(names.append)
        assert file.attrs["complete"]
        return {name: file[name][()] for name in names if isinstance(file[name], h5py.Dataset)} | {
            f"{name}/at": np.array(group.attrs["time"]) for name, group in file["snapshots"].items()
        }


def test_a_run_ends_when_all_is_silent_with_the_same_bits_until_then(bar, tmp_path) -> None:
    whole = run_case(bar(QUIET, "whole"), tmp_path)
    short = run_case(bar({**QUIET, **SILENT}, "short"), tmp_path)
    ended, steps = summary(short)["ended"], summary(short)["steps"]

    assert summary(whole)["ended"] is None
    assert summary(whole)["steps"] == 800 == ended["planned_steps"]
    assert steps < 400
    assert ended["why"] == "silent"
    assert ended["time"] == summary(short)["duration"] == pytest.approx(steps * 2.5e-4, rel=1e-14)
    kept, expected = data_of(short), data_of(whole)
    for name in expected:
        if name.startswith("histories"):
            assert len(kept[name]) == steps
            np.testing.assert_array_equal(kept[name], expected[name][:steps], err_msg=name)
    assert np.abs(expected["histories/middle/velocity"][steps:, 0]).max() < 0.05 * 0.5
    assert kept["0000/at"] == expected["0000/at"] == 100 * 2.5e-4
    assert kept[f"{len([name for name in kept if name.endswith('/at')]) - 1:04d}/at"] == ended["time"]


def test_a_run_that_never_becomes_silent_says_so(bar, tmp_path) -> None:
    grip = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "boundary.right": {"type": "free"}}
    whole = run_case(bar({**QUIET, **SILENT, **grip}, "rings"), tmp_path)  # the pulse goes to and fro
    assert summary(whole)["ended"] is None
    (said,) = (line for line in summary(whole)["warnings"] if line.startswith("run.until: "))
    assert said.startswith(
        'run.until: is "silent", but the run went on for its whole duration, 0.2 s: the monitors did not become silent '
        "(5 % of their peaks), the velocity of monitor.middle is still "
    )


def test_keys_of_silence_without_effect_are_refused(bar, spalling) -> None:
    for changes, said in (
        ({"run.silent_level": 0.1}, 'run.silent_level: is only allowed with until = "silent"'),
        ({"run.until": "silent", "monitor": []}, 'run.until: is "silent", but the case has no monitor'),
        ({"run.until": "silent", "run.silent_for": 0.1}, "run.silent_for: is 0.1, must be at most run.duration, 0.01"),
    ):
        for make in (bar, spalling):
            with pytest.raises(CaseError) as caught:
                make(changes | {"run.duration": 0.01})
            assert any(problem.startswith(said) for problem in caught.value.problems)

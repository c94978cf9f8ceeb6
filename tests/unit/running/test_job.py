"""One case from tables to a folder of results."""

import json
import time

import h5py
import numpy as np
import pytest

from dembound.casefile import Case
from dembound.errors import CaseError, RecordError, RunError
from dembound.kinds import with_changes
from dembound.motion.paths import first_arrivals
from dembound.motion.silence import monitored
from dembound.motion.trackers import Run
from dembound.plot.scene import plot_scene
from dembound.results.folder import OWN
from dembound.results.summary import end_in_words
from dembound.running import SECTIONS, Progress, plan, preflight, resume_case, run_case, warnings_before

GRIP = {"type": "velocity", "wave_p": "pulse"}
BLOW_UP = {"boundary.left": GRIP, "run.duration": 0.05}
"""With the fixture `unstable`: long enough that the motion passes every bound."""
"""A motion so large that forces overflow."""

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


def test_a_step_above_the_limit_is_refused_before_anything_is_written(bar, tmp_path) -> None:
    with pytest.raises(CaseError, match=r"run\.time_step"):
        run_case(bar({"run.time_step": 5e-3}), tmp_path)

    assert not list(tmp_path.iterdir())


def test_a_run_leaves_one_whole_folder(bar, tmp_path) -> None:
    folder = run_case(bar({"output.pictures": True}), tmp_path / "new" / "results")

    assert folder == tmp_path / "new" / "results" / "bar"
    assert list(folder.parent.iterdir()) == [folder]
    names = {path.name for path in folder.iterdir()}
    assert names == {"run.h5", "checkpoint.npz", "summary.json", "paraview", "scene.png", "histories.png"}
    with h5py.File(folder / "run.h5") as file:
        assert file.attrs["complete"]


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
    assert found >= {"paraview/cracks.vtu", "histories_stress.png", "checkpoint.npz", "settled/body.npz"}
    for name in ("notes.txt", "paraview/mine_0000.vtu", "paraview/state.pvsm", "other/run.h5", "run.h5.bak"):
        assert not OWN.fullmatch(name)


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


def test_histories_alone_are_written_without_snapshots(bar, spalling, tmp_path) -> None:
    for case in (bar(), spalling({"output.pictures": True})):
        full, alone = (
            run_case(with_changes(case, {"output.snapshots": number}), tmp_path / str(number)) for number in (1, 0)
        )
        with h5py.File(full / "run.h5") as file, h5py.File(alone / "run.h5") as without:
            assert list(file["snapshots"]) == ["0000"]
            assert len(without["snapshots"]) == 0
            for name, group in file["histories"].items():
                for quantity, values in group.items():
                    assert np.array_equal(values, without["histories"][name][quantity])
            for name, values in file["energy"].items():
                assert np.array_equal(values, without["energy"][name])
        assert (full / "paraview").is_dir()
        assert not (alone / "paraview").exists()
        assert not (alone / "scene.png").exists()
        assert summary(alone)["warnings"] == summary(full)["warnings"]


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
            "ended",
        ),
        *(
            "wall_time",
            "seconds",
            "has_history",
            "threads",
            "particle_steps_per_second",
            "memory_bytes",
            "packing",
            "load_factor",
            "boundaries",
            "monitors",
        ),
        *("laws", "static", "cracks", "energy", "keys", "reduced", "not_reduced", "resumed", "sides", "warnings"),
    }
    assert (found["name"], found["particles"], found["contacts"]) == ("bar", 40, 2 * 19 + 20)
    assert found["duration"] == pytest.approx(found["steps"] * found["time_step"], rel=1e-15)
    assert found["reduced"] == ["rows: 2 identical rows are stepped as one, 20 of 40 disks"]
    assert found["not_reduced"] == []
    assert found["particle_steps_per_second"] == pytest.approx(20 * found["steps"] / found["seconds"]["step"])
    # by hand: ρc_p² shared by contact and bond; rounding and a solve with one unknown
    assert found["packing"]["C11"] == pytest.approx(2.5e9, rel=1e-12)
    assert found["packing"]["C66"] == pytest.approx(0.625e9, rel=1e-12)
    assert found["packing"]["p_wave_speed"] == pytest.approx(1000.0, rel=1e-12)
    assert found["packing"]["s_wave_speed"] is None
    assert found["laws"] == [{"law": "elastic", "from": 0.0}]
    assert (found["static"], found["load_factor"]) == (None, None)
    assert found["cracks"] == {"tension": 0, "shear": 0}
    # the books close to rounding: some 80 steps of sums over 40 particles of 1.1e-16 each
    assert found["energy"]["relative_error"] < 1e-12
    assert found["energy"]["outside"] != 0.0


def test_the_summary_tells_what_the_time_was_spent_on(bar, tmp_path) -> None:
    began = time.perf_counter()
    folder = run_case(bar({**HANGING, "output.pictures": True}), tmp_path, seconds={"import": 1000.0})
    took = time.perf_counter() - began
    found = summary(folder)

    assert tuple(found["seconds"]) == SECTIONS
    assert found["wall_time"] == pytest.approx(sum(found["seconds"].values()), rel=1e-12)
    assert found["seconds"].pop("import") == 1000.0
    # what is left out is the summary itself, and folders that are made and renamed
    assert 0.0 < sum(found["seconds"].values()) <= took
    assert all(
        found["seconds"][section] > 0.0 for section in ("build", "settle", "step", "record", "export", "pictures")
    )


def test_what_was_not_done_took_no_time(bar, tmp_path) -> None:
    seconds = summary(run_case(bar(), tmp_path))["seconds"]

    assert tuple(seconds) == SECTIONS
    assert seconds["import"] == 0.0
    assert seconds["settle"] < 0.1 * sum(seconds.values())
    assert seconds["pictures"] < 0.1 * sum(seconds.values())


def test_the_summary_describes_the_sides(bar, tmp_path) -> None:
    sides = summary(run_case(bar({"run.duration": 0.03, "boundary.right.beta_p": 0.9}), tmp_path))["boundaries"]

    assert {side: described["type"] for side, described in sides.items()} == {
        "left": "viscous_input",
        "right": "viscous",
        "bottom": "free",
        "top": "free",
    }
    right = sides["right"]
    assert (right["particles"], right["length"], right["diameter_sum_ratio"]) == (2, 1.0, 1.0)
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


class Heard(Progress):
    """Writes down what it is told."""

    def __init__(self) -> None:
        self.static: list[tuple[int, float]] = []
        self.blocks: list[tuple[int, int]] = []
        self.warnings: list[tuple[str, int]] = []

    def warned(self, message: str) -> None:
        self.warnings.append((message.split(":")[0], len(self.blocks)))

    def settling(self, steps: int, ratio: float) -> None:
        self.static.append((steps, ratio))

    def running(self, run: Run, steps: int) -> None:
        self.blocks.append((run.state.step, steps))


def test_progress_is_told_after_every_block(bar, tmp_path) -> None:
    heard = Heard()
    run_case(bar({"run.duration": 0.2}), tmp_path, heard)

    done = [steps for steps, _ in heard.blocks]
    (total,) = {of for _, of in heard.blocks}
    assert heard.static == []
    assert done == sorted(done)
    assert done[-1] == total > 256
    assert np.diff([0, *done]).max() <= 256


def test_warnings_are_told_before_and_after_the_run_and_kept(bar, tmp_path) -> None:
    heard = Heard()
    burst = {"type": "sine_burst", "amplitude": 0.5, "frequency": 100.0, "cycles": 4}
    folder = run_case(bar({"wave.pulse": burst, "run.duration": 0.03}), tmp_path, heard)

    # four cycles of 10 m, for which disks of 0.5 m are coarse; the run sees three
    (short, before), (moving, after) = heard.warnings
    assert (short, before) == ("wave.pulse", 0)
    assert (moving, after) == ("monitor.middle", len(heard.blocks))
    assert [warning.split(":")[0] for warning in summary(folder)["warnings"]] == [short, moving]
    assert summary(run_case(bar({"run.duration": 0.4, "wave.pulse.period": 0.07}), tmp_path))["warnings"] == []


def test_what_would_stop_a_case_is_foreseen(bar, spalling) -> None:
    for stopped, said in (
        (bar({"run.time_step": 5e-3}), "run.time_step"),
        (spalling({"run.courant": 2.0}), "run.courant"),
        (bar({"material": {"density": 2500.0, "emod": 1e9, "pb_emod": 0.0}}), "material"),
    ):
        with pytest.raises(CaseError, match=said) as caught:
            preflight(stopped)
        assert caught.value.source == stopped.name
    preflight(bar())
    preflight(spalling())


@pytest.mark.parametrize(("x", "said"), [(5.2, True), (5.8, False)])
def test_monitors_of_one_particle_are_warned_of(bar, x: float, said: bool) -> None:
    """Disks are 0.5 m wide; one is centred at (5.25, 0.25) m."""
    case = bar({"monitor": [{"name": "a", "position": [5.25, 0.25]}, {"name": "b", "position": [x, 0.3]}]})
    assert [line[:10] for line in warnings_before(plan(case)) if "records the same" in line] == said * ["monitor.b:"]


@pytest.mark.parametrize(("snapshots", "said"), [(0, True), (1, False)])
def test_what_only_snapshots_hold_is_missed_without_them(bar, snapshots: int, said: bool) -> None:
    case = bar({"output": {"stress": True, "contacts": True, "snapshots": snapshots}})
    found = [line for line in warnings_before(plan(case)) if line.startswith("output.stress and output.contacts: asks")]
    assert len(found) == said


def test_energies_are_entered_a_hundred_times_or_as_often_as_asked(bar, tmp_path) -> None:
    usual = {"run.time_step": 1e-4, "run.duration": 0.025}
    for name, changes, wanted in (
        ("usual", {}, [*np.arange(0.0, 250.0, 2.0), 249.0]),  # and at the last step
        ("asked", {"output.energy_interval": 1e-3}, [*np.arange(0.0, 250.0, 10.0), 249.0]),
    ):
        with h5py.File(run_case(bar({**usual, **changes}, name), tmp_path) / "run.h5") as file:
            # ten times a step of 1e-4 s, each product rounded
            np.testing.assert_allclose(file["energy/time"], 1e-4 * np.array(wanted), rtol=1e-15)


def test_a_static_stage_is_run_first_and_recorded(bar, tmp_path) -> None:
    heard = Heard()
    folder = run_case(bar(HANGING), tmp_path, heard)

    static = summary(folder)["static"]
    assert heard.static[-1] == (static["steps"], static["ratio"])
    assert static["ratio"] <= 1e-6 < heard.static[0][1]
    # 40 disks of 625 kg hang from two; the mean of their weights and of what is left is what the record says
    assert static["mean_reaction"] == pytest.approx(40 * 625.0 * 9.81 / 2, rel=1e-4)
    assert static["cracks"] == 0
    with h5py.File(folder / "run.h5") as file:
        assert file["static"].attrs["steps"] == static["steps"]
        assert file["static/displacement"].shape == (40, 3)
        assert file["static/displacement"][:, 0].max() > 0.0
        # histories and snapshots count from where the stage ended
        assert np.abs(file["snapshots/0000/displacement"][:, 0]).max() < 1e-6 * file["static/displacement"][:, 0].max()


NICHE = {"name": "niche", "type": "rectangle", "corners": [6.0, 0.5, 8.0, 1.1], "stage": "after"}
"""Four disks of the upper row."""


def test_an_excavation_is_recorded_with_what_was_before(bar, tmp_path) -> None:
    heard = Heard()
    folder = run_case(bar({**HANGING, "hole": [NICHE]}), tmp_path, heard)

    static = summary(folder)["static"]
    before = static["before"]
    assert before["before"] is None
    assert {(stage["steps"], stage["ratio"]) for stage in (before, static)} <= set(heard.static)
    for stage, disks in ((before, 40), (static, 36)):
        assert stage["mean_reaction"] == pytest.approx(disks * 625.0 * 9.81 / 2, rel=1e-4)
    with h5py.File(folder / "run.h5") as file:
        assert file["static/before"].attrs["steps"] == before["steps"]
        x, y = file["particles/position"][:].T
        assert not ((x > 6.0) & (x < 8.0) & (y > 0.5)).any()
        first, last = (file[f"{stage}/displacement"][:, 0] for stage in ("static/before", "static"))
        assert first.shape == last.shape == (36,)
        # with four weights less to carry, the bar springs back where only that has changed
        assert np.all(last[(x > 0.5) & (x < 5.5)] < first[(x > 0.5) & (x < 5.5)])


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


def test_a_run_that_fails_leaves_a_partial_folder_with_what_there_was(bar, tmp_path, unstable) -> None:
    with unstable(), pytest.raises(RunError, match="grew without bound"):
        run_case(bar(BLOW_UP), tmp_path)

    assert [path.name for path in tmp_path.iterdir()] == ["bar.partial"]
    with h5py.File(tmp_path / "bar.partial" / "run.h5") as file:
        assert not file.attrs["complete"]


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
    plot_scene(tmp_path / "bar.partial" / "run.h5", field="unbalanced")

    run_case(bar(HANGING), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["bar"]


@pytest.mark.parametrize("wave", [{}, {"wave": "pulse"}])
def test_a_load_beside_all_particles_is_found_before_anything_is_written(bar, tmp_path, wave: dict) -> None:
    between = {"name": "push", "force": [1.0, 0.0], "region": [3.01, 0.3, 3.02, 0.31], **wave}
    with pytest.raises(CaseError, match="no particle is centred"):
        run_case(bar({"load": [between]}), tmp_path)
    assert not list(tmp_path.iterdir())


def finished_then_failed(bar, tmp_path, unstable) -> Case:
    run_case(bar(), tmp_path)
    with unstable(), pytest.raises(RunError):
        run_case(bar(BLOW_UP), tmp_path)
    return bar()


def test_earlier_results_outlive_a_run_that_fails(bar, tmp_path, unstable) -> None:
    finished_then_failed(bar, tmp_path, unstable)

    assert sorted(path.name for path in tmp_path.iterdir()) == ["bar", "bar.partial"]
    assert summary(tmp_path / "bar")["steps"] == 29


def test_a_new_run_takes_the_place_of_what_earlier_ones_left(bar, tmp_path, unstable) -> None:
    case = finished_then_failed(bar, tmp_path, unstable)
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


def test_a_bar_is_run_from_its_tables_to_a_folder(spalling, tmp_path) -> None:
    changes = {"output.pictures": True, "output.snapshots": 3, "method": {"type": "patch", "horizon": 3, "reach": 1}}
    folder = run_case(spalling({**changes, "run.courant": 0.9}), tmp_path)

    names = {path.name for path in folder.iterdir()}
    pictures = {"scene.png", "histories.png", "histories_stress.png"}
    assert names == {"run.h5", "checkpoint.npz", "summary.json", "paraview"} | pictures
    found = summary(folder)
    assert found["steps"] == 67  # 60/0.9
    assert found["courant"] == pytest.approx(0.9, rel=1e-12)
    assert len(found["spalls"]) > 0
    assert len(found["laws"]) == 2
    with h5py.File(folder / "run.h5") as file:
        assert file.attrs["complete"]
        assert [len(group["damage"]) for group in file["snapshots"].values()] == [41, 41, 41]
        assert file["histories/gauge/stress"].shape == (67,)


def test_blocks_of_a_bar_are_longer(spalling, tmp_path) -> None:
    heard = Heard()
    quiet = {"run.duration": 0.1, "output.pictures": False, "output.energy_interval": 0.1, "output.snapshots": 1}
    run_case(spalling(quiet), tmp_path, heard)

    # the first step and the last are entered in the ledger, and stand alone
    assert [done for done, _ in heard.blocks] == [1, 2048, 3999, 4000]


def test_a_run_that_would_never_end_is_refused(spalling) -> None:
    with pytest.raises(CaseError, match=r"^run.duration: takes \S+ steps of \S+ s, must take no more than 1e\+11$"):
        plan(spalling({"run.courant": 1e-30}))


def test_a_bars_step_above_the_limit_is_refused_before_anything_is_written(spalling, tmp_path) -> None:
    with pytest.raises(CaseError, match=r"run\.courant: is 2, must not be above 1\.96") as caught:
        run_case(spalling({"run.courant": 2.0}), tmp_path)

    assert caught.value.source == "spalling"
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", ["bar", "spalling"])
def test_preflight_finds_a_run_that_would_never_end(request, kind: str) -> None:
    step = {"bar": {"run.time_step": 1e-12}, "spalling": {}}[kind]
    case = request.getfixturevalue(kind)({"run.duration": 1e9, **step})
    with pytest.raises(CaseError, match=r"run\.duration: takes .* must take no more than"):
        preflight(case)


QUIET = {"run.duration": 0.2, "run.time_step": 2.5e-4, "output.snapshots": 40}
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


@pytest.mark.parametrize("rows", [True, False])
def test_a_run_ends_when_all_is_silent_with_the_same_bits_until_then(bar, tmp_path, rows) -> None:
    whole = run_case(bar({**QUIET, "reduce.rows": rows}, "whole"), tmp_path)
    short = run_case(bar({**QUIET, **SILENT, "reduce.rows": rows}, "short"), tmp_path)
    ended, steps = summary(short)["ended"], summary(short)["steps"]

    assert summary(whole)["ended"] is None
    assert summary(whole)["steps"] == 800 == ended["planned_steps"]
    assert steps < 400
    assert ended["why"] == "silent"
    assert ended["time"] == summary(short)["duration"] == pytest.approx(steps * 2.5e-4, rel=1e-14)
    assert ended["saved"] == 1.0 - steps / 800
    assert end_in_words(summary(short)) == [
        f"ended at {ended['time']:.4g} s, all monitors silent: {100.0 * (1.0 - steps / 800):.0f} % of the steps saved"
    ]
    assert end_in_words(summary(whole)) == []
    kept, expected = data_of(short), data_of(whole)
    for name in expected:
        if name.startswith("histories"):
            assert len(kept[name]) == steps
            np.testing.assert_array_equal(kept[name], expected[name][:steps], err_msg=name)
    assert np.abs(expected["histories/middle/velocity"][steps:, 0]).max() < 0.05 * 0.5
    assert kept["0000/at"] == expected["0000/at"] == 20 * 2.5e-4
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
    # over at 0.02 s, but all must be silent for the time of a slow wave to the farther side and back
    late = run_case(bar({**QUIET, **SILENT, "run.duration": 0.025}, "late"), tmp_path)
    (said,) = (line for line in summary(late)["warnings"] if line.startswith("run.until: "))
    assert "not all were so for long enough, or waves had not passed them all" in said
    for changes in (QUIET, {**QUIET, **SILENT}):
        warnings = summary(run_case(bar(changes, "other"), tmp_path))["warnings"]
        assert not any(line.startswith("run.until") for line in warnings)


def test_a_bar_of_nodes_ends_when_it_is_silent(spalling, tmp_path) -> None:
    changes = {"boundary.right": {"type": "viscous"}, "bar.strength": 1e12, "run.duration": 0.02}
    changes |= {"method": {"type": "finite_difference"}, "load.hit.nodes": 1}
    whole = run_case(spalling(changes, "whole"), tmp_path)
    short = run_case(spalling({**changes, "run.until": "silent"}, "short"), tmp_path)
    kept, expected = data_of(short), data_of(whole)
    steps = summary(short)["steps"]

    assert steps < summary(whole)["steps"] == summary(short)["ended"]["planned_steps"]
    for name in ("velocity", "displacement", "stress"):
        np.testing.assert_array_equal(
            kept[f"histories/gauge/{name}"], expected[f"histories/gauge/{name}"][:steps], err_msg=name
        )


def test_a_load_that_starts_later_is_waited_for(bar, tmp_path) -> None:
    blow = {"name": "blow", "force": [1e6, 0.0], "region": [0.0, 0.0, 0.5, 1.0], "wave": "late"}
    late = {"type": "cosine", "amplitude": 1.0, "period": 0.01, "start": 0.1}
    folder = run_case(bar({**QUIET, **SILENT, "run.duration": 0.5, "load": [blow], "wave.late": late}), tmp_path)
    histories = data_of(folder)

    assert 0.11 < summary(folder)["ended"]["time"] < 0.3
    late_part = histories["histories/middle/time"] > 0.1
    assert np.abs(histories["histories/middle/velocity"][late_part]).max() > 0.1


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"run.silent_level": 0.1}, 'run.silent_level: is only allowed with until = "silent"'),
        ({"run.silent_for": 0.1}, 'run.silent_for: is only allowed with until = "silent"'),
        ({"run.until": "silent", "monitor": []}, 'run.until: is "silent", but the case has no monitor'),
        ({"run.until": "silent", "run.silent_for": 0.1}, "run.silent_for: is 0.1, must be at most run.duration, 0.01"),
    ],
)
@pytest.mark.parametrize("kind", ["bar", "spalling"])
def test_keys_of_silence_without_effect_are_refused(request, kind, changes, said) -> None:
    with pytest.raises(CaseError) as caught:
        request.getfixturevalue(kind)(changes | {"run.duration": 0.01})

    assert any(problem.startswith(said) for problem in caught.value.problems)


@pytest.mark.parametrize(("duration", "late"), [(0.9, True), (1.1, False)])
def test_monitors_that_no_wave_reaches_are_named_before_the_run(bar, duration: float, late: bool) -> None:
    """The monitor of the farther end: its way over the speed of the fastest waves, of which `duration` is a share."""
    planned = plan(bar())
    first = first_arrivals(
        planned.kind.sources(planned.scene),
        planned.kind.front(planned.scene, planned.time_step),
        monitored(planned.scene),
    )
    farthest = planned.scene.case.monitor[int(first.argmax())].name
    lines = warnings_before(plan(bar({"run.duration": duration * float(first.max())})))
    found = [line for line in lines if "the first wave reaches it" in line]
    assert [farthest in line and f"reaches it at {first.max():.4g} s" in line for line in found] == late * [True]


def test_a_refused_resume_leaves_nothing_beside_the_results(bar, tmp_path) -> None:
    folder = run_case(bar(), tmp_path)
    with h5py.File(folder / "run.h5", "a") as file:
        times = next(iter(file["histories"].values()))["time"]
        times[...] = times[:][::-1]
    with pytest.raises(RecordError, match="do not increase"):
        resume_case(folder, until=0.02)
    assert [path.name for path in tmp_path.iterdir()] == [folder.name]

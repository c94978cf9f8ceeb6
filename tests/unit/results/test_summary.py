"""Entries of the summary of a run, and whether record, summary and case file belong together."""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from small_cases import SPALLING, small

import dembound
from dembound.errors import RecordError
from dembound.motion.energy import Ledger
from dembound.motion.kind import Plan
from dembound.motion.simulation import Simulation
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories
from dembound.results.summary import arrival, read_summary, summarise
from dembound.results.text_files import write_json
from dembound.running import plan, run_case
from dembound.running.unfinished import changes_since

SECONDS = {"build": 0.25, "step": 2.0, "record": 0.5}


def summary_of(planned: Plan, path: Path, steps: int, entries: int) -> dict:
    """The summary of a run of some steps, energies entered now and then."""
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    ledger = Ledger(simulation, steps // entries)
    with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), ledger)
        simulation.run(steps)
    return json.loads(json.dumps(summarise(planned, simulation, path, SECONDS), allow_nan=False))


def test_energies_are_those_of_the_last_entry_and_the_rate_that_of_stepping_alone(bar, tmp_path) -> None:
    summary = summary_of(plan(bar()), tmp_path / "run.h5", 60, 6)
    assert summary["wall_time"] == 2.75
    assert summary["particle_steps_per_second"] == 40 * 60 / 2.0
    found = summary["energy"]
    assert found["time"] == pytest.approx(50 / 60 * 60 * plan(bar()).time_step, rel=1e-12)
    stored = found["kinetic"] + found["contact"] + found["bond"] + found["stepping"]
    # 60 steps of sums of 40 particles, each rounded, beside the work of the whole
    assert stored == pytest.approx(found["outside"], abs=60 * 40 * np.finfo(float).eps * abs(found["kinetic"] + 1e4))
    assert found["relative_error"] < 60 * 40 * np.finfo(float).eps
    assert found["damping"] == found["friction"] == found["crack"] == 0.0
    # nor is there an error of nothing
    still = plan(bar({"wave.pulse.start": 1.0}))
    assert summary_of(still, tmp_path / "run.h5", 10, 1)["energy"]["relative_error"] == 0.0


TIME = np.arange(5.0)


def test_arrival_is_where_half_the_peak_is_passed_between_two_samples() -> None:
    def of(component: str, peak: float, at: float | None, came: object) -> dict:
        return {"component": component, "peak_velocity": peak, "peak_time": at, "arrival": came}

    x, y = [0.0, 1.0, 4.0, 1.0, 0.0], [0.0, 0.0, -2.0, 0.0, 1.5]
    # half of 4 lies a third of the way from 1 to 4
    assert arrival(TIME, np.column_stack([x, np.zeros(5)])) == of("x", 4.0, 2.0, pytest.approx(4.0 / 3.0, rel=1e-15))
    # of the component that moves most, with its sign
    assert arrival(TIME, np.column_stack([np.full(5, 0.1), y])) == of("y", -2.0, 2.0, 1.5)
    assert arrival(TIME, np.ones((5, 2)))["arrival"] == 0.0  # there from the start
    assert arrival(TIME, np.zeros((5, 2))) == of("x", 0.0, None, None)


def refused(constant: str) -> float:
    raise AssertionError(constant)


def test_numbers_that_are_not_finite_are_null(tmp_path: Path) -> None:
    values = {"a": math.nan, "b": [1.0, math.inf, {"c": (-math.inf, "NaN", True, None)}], "d": 1e308}
    write_json(tmp_path / "found.json", values)
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"), parse_constant=refused)

    assert found == {"a": None, "b": [1.0, None, {"c": [None, "NaN", True, None]}], "d": 1e308}
    assert [path.name for path in tmp_path.iterdir()] == ["found.json"]


SHORT = {"run.duration": 1e-4, "output": {"pictures": False}}


def written(folder: Path, **changes: float) -> Path:
    """The file a.toml of a short case in a folder."""
    folder.mkdir(exist_ok=True)
    path = folder / "a.toml"
    keys = {key.replace("__", "."): value for key, value in changes.items()}
    path.write_text(small(SPALLING, changes=SHORT | keys).text)
    return path


def test_a_case_file_that_has_changed_since_the_run_began_is_named_with_its_keys(tmp_path) -> None:
    case = written(tmp_path)
    folder = run_case(dembound.change(dembound.load(case), {"bar.density": 2600.0}), tmp_path)
    assert changes_since(folder) == []  # changed by an option, not in the file
    written(tmp_path, run__duration=2e-4)
    assert changes_since(folder) != []  # as bar.density is another one there
    written(tmp_path, bar__density=2600.0, run__duration=2e-4)
    assert changes_since(folder) == []  # when it ends is for --until
    written(tmp_path, bar__density=2400.0)
    (said,) = changes_since(folder)
    assert "has changed since the run began (bar.density); the case as it was goes on" in said
    os.remove(case)
    assert changes_since(folder) == []


def test_a_wave_file_that_has_changed_since_the_run_began_is_named(tmp_path) -> None:
    wave = tmp_path / "records" / "hit.txt"
    wave.parent.mkdir()
    wave.write_text("0 0\n1e-5 1\n2e-5 0\n")
    case = tmp_path / "a.toml"
    tables = SPALLING | {"wave": {"hit": {"type": "file", "path": "records/hit.txt"}}}
    tables["load"] = [load | {"wave": "hit"} for load in tables["load"]]
    case.write_text(tomli_w.dumps(tables | {"run": {"duration": 1e-4}, "output": {"pictures": False}}))
    folder = run_case(dembound.load(case), tmp_path)
    assert changes_since(folder) == []
    wave.write_text("0 0\n1e-5 2\n2e-5 0\n")
    (said,) = changes_since(folder)
    assert said.startswith(f"{wave}: has changed since the run began; its values as they were go on")


@pytest.mark.parametrize(("name", "value"), [("steps", 7), ("keys", {})])
def test_a_summary_of_another_run_is_refused(tmp_path, name: str, value: object) -> None:
    folder = run_case(small(SPALLING, changes=SHORT), tmp_path)
    summary = read_summary(folder)
    (folder / "summary.json").write_text(json.dumps(summary | {name: value}))
    with pytest.raises(RecordError, match=f"is of another run than run.h5 beside it: their {name} differ"):
        read_summary(folder)

"""A member by itself: its values are those of a run or a calibration alone."""

import json

import numba
import numpy as np
import pytest

from dembound.results.reader import open_record
from dembound.results.results import Results
from dembound.running import job, run_case
from dembound.studies.all_sides import calibrate_all
from dembound.studies.asked import Calibrating
from dembound.studies.sweep.members import ENERGY, members_of, unit_of, variations
from dembound.studies.sweep.perform import ALONE, MEMBERS, outcome_in, perform


def test_values_are_those_of_the_run_alone(rods, task, tmp_path) -> None:
    (member,) = rods(12e6, **{"output.estimate": True, "output.history_interval": 3e-4})
    outcome = perform(task(member))
    alone = Results(run_case(member.case, tmp_path / "alone"))
    assert outcome.failure == ""
    assert outcome_in(tmp_path, member.key) == outcome
    assert (tmp_path / "begun").is_file()
    values, summary = outcome.values, alone.summary
    assert any("errors are not estimated: " in line for line in outcome.warnings)  # for which it is complete anyway
    assert values["spalls.1.time"] == summary["spalls"][0]["time"]
    assert values["spalls.1.end.to"] == summary["spalls"][0]["end"][1]
    assert values["energy.kinetic"] == summary["energy"]["kinetic"]
    velocity = alone.histories["gauge"]["velocity"][:, 0]
    assert values["monitors.gauge.peak_velocity.x"] == np.abs(velocity).max()
    assert values["monitors.gauge.rms_velocity.x"] == pytest.approx(np.sqrt(np.mean(velocity**2)), rel=1e-14)
    assert not {name.split(".")[0] for name in values} & {"keys", "seconds", "wall_time", "memory_bytes", "threads"}
    with open_record(tmp_path / MEMBERS / member.name / "run.h5") as file:
        assert np.array_equal(file["histories/gauge/velocity"][:, 0], velocity)


def test_units_are_those_of_the_last_part() -> None:
    found = {
        "monitors.end.peak_velocity.x": "m/s",
        "energy.kinetic": ENERGY,
        "energy.relative_error": "1",
        "stress.gauge.tension": "Pa",
        "spalls.1.start.from": "m",
        "bar.section": "m²",
    }
    assert {name: unit_of(name) for name in found} == found


def test_calibrations_are_those_of_the_case_alone(bar, task) -> None:
    changes = variations({"wave.pulse.amplitude": [0.5]}, False)
    for method in ("impedance", "homogenised"):
        ((member,), _) = members_of(bar(), changes, "calibrate", method)
        values = perform(task(member, "calibrate", method)).values
        (right,) = [each for each in calibrate_all(member.case, Calibrating(method=method)) if each.side == "right"][:1]
        assert values["boundary.right.beta_p"] == right.result
        assert values["boundary.right.beta_p.passes"] == len(right.beta)
        assert ("boundary.right.beta_p.ratio" in values) == (method == "impedance")


def test_failures_and_bugs_are_outcomes(rods, task, tmp_path, monkeypatch) -> None:
    (unstable,) = rods(12e6, **{"run.courant": 3.0})
    outcome = perform(task(unstable))
    assert outcome.failure.startswith("run.courant: is 3")
    assert outcome_in(tmp_path, unstable.key) == outcome
    (member,) = rods(12e6)
    monkeypatch.setattr(job, "plan", lambda *_: 1 / 0)
    assert perform(task(member)).failure == "a bug: ZeroDivisionError: division by zero"
    assert not ALONE.locked()
    # one thread is used, and others are given back
    seen, threads = [], numba.get_num_threads
    before = threads()
    run = {"run": lambda _: seen.append(threads()) or ({}, [])}
    monkeypatch.setattr("dembound.studies.sweep.perform._ACTIONS", run)
    perform(task(member))
    assert seen == [1]
    assert threads() == before


def test_a_stopped_member_is_continued_to_the_same_results(rods, task, tmp_path, monkeypatch) -> None:
    (member,) = rods(12e6)
    whole = perform(task(member))
    (tmp_path / "outcomes" / f"{member.key}.json").unlink()

    def touched_soon(self, run, steps):
        if run.state.step > 20:
            (tmp_path / "stop").touch()

    with monkeypatch.context() as patch:
        patch.setattr("dembound.studies.sweep.perform.Begun.running", touched_soon)
        assert perform(task(member)) is None
    assert outcome_in(tmp_path, member.key) is None
    partial = tmp_path / MEMBERS / f"{member.name}.partial"
    assert (partial / "checkpoint.npz").is_file()
    assert perform(task(member)) is None  # as the request to stop is still there
    (tmp_path / "stop").unlink()
    assert perform(task(member)).values == whole.values
    summary = json.loads((tmp_path / MEMBERS / member.name / "summary.json").read_text())
    assert [each["stage"] for each in summary["resumed"]] == [None]

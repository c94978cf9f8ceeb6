"""Entries of the summary of a run."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dembound.motion.energy import Ledger
from dembound.motion.kind import Plan
from dembound.motion.simulation import Simulation
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories
from dembound.results.summary import arrival, summarise
from dembound.results.text_files import write_json
from dembound.running import plan

SECONDS = {"build": 0.25, "step": 2.0, "record": 0.5}


def summary_of(planned: Plan, path: Path, steps: int, entries: int) -> dict:
    """The summary of a run of some steps, energies entered now and then."""
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    ledger = Ledger(simulation, steps // entries)
    with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), ledger)
        simulation.run(steps)
    return json.loads(json.dumps(summarise(planned, simulation, path, SECONDS), allow_nan=False))


def test_an_infinite_step_limit_is_null(bar, tmp_path) -> None:
    planned = replace(plan(bar({"monitor": []})), step_limit=np.inf)
    assert summary_of(planned, tmp_path / "run.h5", 10, 2)["step_limit"] is None


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

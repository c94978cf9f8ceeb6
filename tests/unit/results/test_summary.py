"""What scripts read of a run."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories
from dembound.results.summary import _fields_left_out, arrival, summarise
from dembound.running import plan

SECONDS = {"build": 0.25, "step": 2.0, "record": 0.5}


def summary_of(case: Case, path: Path, steps: int, entries: int) -> dict:
    """The summary of a run of some steps, energies entered now and then."""
    planned = plan(case)
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    ledger = Ledger(simulation, steps // entries)
    with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), ledger)
        simulation.run(steps)
    return json.loads(json.dumps(summarise(planned, simulation, path, SECONDS), allow_nan=False))


PULLED = {
    "material.law": "linearpbond",
    "material.pb_ten": 1e6,
    "boundary.left": {"type": "velocity", "wave_p": "pulse"},
    "wave.pulse.amplitude": -5.0,
}


def test_laws_and_cracks_are_told(bar, tmp_path) -> None:
    found = summary_of(bar(PULLED), tmp_path / "run.h5", 60, 6)
    first, second = found["laws"]

    assert first == {"law": "elastic", "from": 0.0}
    assert second["law"] == "linearpbond"
    assert 0.0 <= second["from"] < found["duration"]
    assert found["cracks"]["tension"] > 0
    assert found["cracks"]["shear"] == 0
    assert found["energy"]["crack"] > 0.0


def test_seconds_are_told_and_the_rate_is_that_of_stepping_alone(bar, tmp_path) -> None:
    found = summary_of(bar(), tmp_path / "run.h5", 60, 6)

    assert found["seconds"] == SECONDS
    assert found["wall_time"] == 2.75
    assert found["particle_steps_per_second"] == 40 * 60 / 2.0


def test_an_infinite_step_limit_is_null(bar, tmp_path) -> None:
    planned = replace(plan(bar({"monitor": []})), step_limit=np.inf)
    simulation = Simulation(planned.scene, planned.time_step)
    ledger = Ledger(simulation, 5)
    with Recorder(tmp_path / "run.h5", simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), ledger)
        simulation.run(10)

    assert summarise(planned, simulation, tmp_path / "run.h5", SECONDS)["step_limit"] is None


def test_energies_are_those_of_the_last_entry(bar, tmp_path) -> None:
    found = summary_of(bar(), tmp_path / "run.h5", 60, 6)["energy"]

    assert found["time"] == pytest.approx(50 / 60 * 60 * plan(bar()).time_step, rel=1e-12)
    stored = found["kinetic"] + found["contact"] + found["bond"] + found["stepping"]
    # 60 steps of sums of 40 particles, each rounded, beside the work of the whole
    assert stored == pytest.approx(found["outside"], abs=60 * 40 * np.finfo(float).eps * abs(found["kinetic"] + 1e4))
    assert found["relative_error"] < 60 * 40 * np.finfo(float).eps
    assert found["damping"] == found["friction"] == found["crack"] == 0.0


def test_a_run_in_which_nothing_happens_has_no_error(bar, tmp_path) -> None:
    assert summary_of(bar({"wave.pulse.start": 1.0}), tmp_path / "run.h5", 10, 1)["energy"]["relative_error"] == 0.0


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


def test_fields_that_are_not_kept_are_named_where_they_are_large(bar) -> None:
    few, many = {"packing.size": [10.0, 1.0]}, {"packing.size": [500.0, 12.0], "run.time_step": 1e-4}
    left_out = {
        (number, name): _fields_left_out(plan(bar({**size, "output.snapshots": number})))
        for number in (0, 1)
        for name, size in (("few", few), ("many", many))
    }

    assert left_out == {
        (0, "few"): [],
        (0, "many"): ["fields: no snapshot is kept, 1.15 MB each"],
        (1, "few"): [],
        (1, "many"): [],
    }

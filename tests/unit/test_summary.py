"""What scripts read of a run."""

import json
from pathlib import Path

import numpy as np
import pytest

from dembound.case import Case
from dembound.record import Recorder
from dembound.run import plan
from dembound.scene import build
from dembound.simulate import Simulation
from dembound.static import settle
from dembound.summary import arrival, describe_packing, describe_side, summarise


def test_the_packing_is_described_where_a_motion_is_held(bar) -> None:
    described = describe_packing(build(bar({"motion.held": ["y", "rotation"]})))

    assert described["p_wave_speed"] == pytest.approx(1000.0, rel=1e-12)
    assert described["s_wave_speed"] is None


def test_a_side_is_described_by_its_particles_and_its_keys(bar) -> None:
    scene = build(bar({"boundary.right.half_mass": True, "boundary.right.beta_p": 0.9}))

    assert describe_side(scene, "right") == {
        "type": "viscous",
        "particles": 2,
        "length": 1.0,
        "diameter_min": 0.5,
        "diameter_mean": 0.5,
        "diameter_max": 0.5,
        "cover": 1.0,
        "beta_p": 0.9,
        "beta_s": 1.0,
        "half_mass": True,
    }
    assert set(describe_side(scene, "top")) & {"beta_p", "half_mass", "alpha_n"} == set()


def test_springs_of_a_side_are_described(bar) -> None:
    springs = {"type": "viscoelastic", "source": [0.0, 0.25], "alpha_n": 2.0}
    found = describe_side(build(bar({"boundary.right": springs, "material.s_wave_speed": 500.0})), "right")

    assert (found["alpha_n"], found["alpha_s"]) == (2.0, 0.5)
    assert found["shear_modulus"] == pytest.approx(2500.0 * 500.0**2)
    # disks at 9.75 m, of heights 0.25 m and 0.75 m
    assert found["distance_min"] == pytest.approx(9.75)
    assert found["distance_max"] == pytest.approx(np.hypot(9.75, 0.5))


def summary_of(case: Case, path: Path, steps: int, entries: int) -> dict:
    """The summary of a run of some steps after its static stage, if any, energies entered now and then."""
    planned = plan(case)
    settled = settle(planned.scene) if case.static is not None else None
    start = settled.start if settled else None
    monitors = np.array(list(planned.scene.monitors.values()), dtype=np.int64)
    simulation = Simulation(planned.scene, planned.time_step, monitors, start=start)
    with Recorder(path, simulation, planned.step_limit, 0.0, settled) as recorder:
        for _ in range(entries):
            recorder.append(recorder.enter_energy())
            recorder.append(simulation.advance(steps // entries - 1))
    return json.loads(json.dumps(summarise(planned, simulation, settled, path, 2.0), allow_nan=False))


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
    assert found["particle_steps_per_second"] == 40 * 60 / 2.0


def test_energies_are_those_of_the_last_entry(bar, tmp_path) -> None:
    found = summary_of(bar(), tmp_path / "run.h5", 60, 6)["energy"]

    assert found["time"] == pytest.approx(50 / 60 * 60 * plan(bar()).time_step, rel=1e-12)
    stored = found["kinetic"] + found["contact"] + found["bond"]
    # 60 steps of sums of 40 particles, each rounded, beside the work of the whole
    assert stored == pytest.approx(found["outside"], abs=60 * 40 * np.finfo(float).eps * abs(found["kinetic"] + 1e4))
    assert found["relative_error"] < 60 * 40 * np.finfo(float).eps
    assert found["damping"] == found["friction"] == found["crack"] == 0.0


def test_a_run_in_which_nothing_happens_has_no_error(bar, tmp_path) -> None:
    assert summary_of(bar({"wave.pulse.start": 1.0}), tmp_path / "run.h5", 10, 1)["energy"]["relative_error"] == 0.0


def test_the_static_stage_is_told(bar, tmp_path) -> None:
    weight = {"name": "weight", "acceleration": [9.81, 0.0]}
    case = bar({"load": [weight], "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}}})
    found = summary_of(case, tmp_path / "run.h5", 10, 1)["static"]

    assert set(found) == {"steps", "ratio", "carried", "left", "stress", "asked", "cracks", "before", "column"}
    assert found["before"] is None
    assert found["ratio"] <= 1e-6
    assert found["left"] < 1e-4 * found["carried"]
    # 20 disks in a row: contacts bear 1 to 19 weights, half of each on either disk, 190 in all; strains are below 1e-3
    assert found["stress"][0] == pytest.approx(190 / 20 * 625.0 * 9.81 / 0.5, rel=1e-3)
    assert found["carried"] == pytest.approx(20 * 625.0 * 9.81, rel=1e-4)


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

"""Entries of the summary of disks and their run."""

import json

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds.disks.summary import (
    asked_stress,
    describe_side,
    describe_static,
    summarise_disks,
)
from dembound.motion.simulation import Simulation
from dembound.running import plan

SHEARED = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": 500.0}


def test_a_side_is_described_by_its_particles_and_its_keys(bar) -> None:
    scene = build(bar({"boundary.right.half_mass": True, "boundary.right.beta_p": 0.9}))
    disks = {"particles": 2, "length": 1.0, "diameter_min": 0.5, "diameter_mean": 0.5, "diameter_max": 0.5}
    factors = {"beta_p": 0.9, "beta_s": 1.0, "matched_p": pytest.approx(1.0, rel=1e-12), "matched_s": None}  # y is held
    expected = {"type": "viscous", "diameter_sum_ratio": 1.0, "half_mass": True, **disks, **factors}

    assert describe_side(scene, "right") == expected
    assert set(describe_side(scene, "top")) & {"beta_p", "half_mass", "alpha_n"} == set()
    springs = {"type": "viscoelastic", "source": [0.0, 0.25], "alpha_n": 2.0}
    found = describe_side(build(bar({"boundary.right": springs, "material": SHEARED})), "right")
    assert (found["alpha_n"], found["alpha_s"]) == (2.0, 0.5)
    assert found["shear_modulus"] == pytest.approx(2500.0 * 500.0**2)
    # disks at 9.75 m, of heights 0.25 m and 0.75 m
    assert (found["distance_min"], found["distance_max"]) == pytest.approx((9.75, np.hypot(9.75, 0.5)))


def test_the_static_stage_is_reported(bar) -> None:
    weight = {"name": "weight", "acceleration": [9.81, 0.0]}
    case = bar({"load": [weight], "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}}})
    scene = build(case)
    found = json.loads(json.dumps(describe_static(settle(scene), asked_stress(scene)), allow_nan=False))

    named = "steps ratio mean_reaction mean_residual stress asked uniformity elastic cracks before column"
    assert set(found) == set(named.split())
    assert found["before"] is found["column"] is found["asked"] is found["uniformity"] is None
    assert found["elastic"]
    assert found["ratio"] <= 1e-6
    assert found["mean_residual"] < 1e-4 * found["mean_reaction"]
    # 20 disks in a row: contacts bear 1 to 19 weights, and those of the middle 6 m of 10 m 10 on the mean
    assert found["stress"][0] == pytest.approx(10.0 * 625.0 * 9.81 / 0.5, rel=1e-3)
    assert found["mean_reaction"] == pytest.approx(20 * 625.0 * 9.81, rel=1e-4)
    assert asked_stress(build(bar({"static": {"stress": [-1e6, -2e6, 0.5e6]}}))) == [-1e6, -2e6, 0.5e6]


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_the_summary_of_disks_is_plain_json(bar, law: str) -> None:
    planned = plan(bar({"material.law": law}))
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.advance(60)
    found = json.loads(json.dumps(summarise_disks(planned.scene, simulation), allow_nan=False))

    of_scene = {"particles", "has_history", "contacts", "loose_disks_left_out", "packing", "layers", "boundaries"}
    assert set(found) == of_scene | {"load_factor", "forces_at_rest", "far", "turns"}
    assert found["load_factor"] is None
    assert (found["particles"], found["contacts"], found["loose_disks_left_out"]) == (40, 2 * 19 + 20, 0)
    assert found["has_history"] == (law == "linearpbond")
    assert found["boundaries"]["right"]["peak_velocity"][0] > 0.4  # of a pulse of 0.5 m/s

"""Entries of the summary of disks and their run."""

import json

import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds.disks.summary import (
    asked_stress,
    describe_static,
    summarise_disks,
)
from dembound.motion.simulation import Simulation
from dembound.running import plan


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

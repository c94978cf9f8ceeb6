"""Entries of the summary of disks and their run, and its results in words."""

import json

import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds.disks.summary import (
    asked_stress,
    describe_static,
    disk_outcome,
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


def test_only_what_applies_is_reported() -> None:
    elastic = {"static": None, "has_history": False, "laws": [{"law": "elastic", "from": 0.0}]}
    elastic |= {"seconds": {"settle": 4.2}, "reduced": [], "not_reduced": [], "load_factor": None}
    quiet = {"has_history": True, "cracks": {"tension": 0, "shear": 0}, "energy": {"relative_error": 0.0}}
    settled = {"steps": 3100, "ratio": 9.84e-6, "cracks": 0, "elastic": True}
    settled |= dict.fromkeys(("before", "asked", "column"))
    steps = "3,100 steps, unbalanced force ratio 9.8e-06"
    stage, took = f"static stage: {steps}", "; 4.2 s"

    assert disk_outcome(elastic) == []
    said = "contacts slid or opened while the body settled, so that its rest is one of several: dembound estimate says"
    assert disk_outcome(elastic | {"static": settled | {"elastic": False}})[1].startswith(said)
    first = {"factor": 1.25, "limit": "slides", "time": 0.5, "position": [3.0, 4.0], "particles": [1, 2]}
    assert disk_outcome(elastic | {"load_factor": first}) == [
        "the elastic law holds up to 1.25 times the waves, where the pair at (3, 4) m slides at t = 0.5 s"
    ]
    draw = ", one draw of many: see dembound estimate --repeat"
    broken = {"cracks": {"tension": 1200, "shear": 30}, "static": settled | {"cracks": 1100}}
    assert disk_outcome(elastic | quiet | broken) == [
        f"{stage}, breaking 1,100 bonds{took}",
        "elastic law all through",
        f"1,230 bonds broke in all (1,200 tension, 30 shear){draw}",
    ]
    at_rest = {"cracks": {"tension": 20, "shear": 4}, "static": settled | {"cracks": 24}}
    assert disk_outcome(elastic | quiet | at_rest)[::2] == [
        f"{stage}, breaking 24 bonds{took}",
        "bonds broke only in the static stage (20 tension, 4 shear)",
    ]
    even = {"block": [5.0, 6.25], "deviation": 0.0123, "packing": 1e-6, "beyond": 0.0123, "near_holes": None}
    pressed = settled | {"asked": [-1e6, -2e6, 0.0], "stress": [-0.5e6, -2e6, 1e-3], "uniformity": even}
    reached = f"{stage}, stress (-0.5, -2, 0) of (-1, -2, 0) MPa requested, within 1.2 % in blocks of"
    assert disk_outcome(elastic | {"static": pressed}) == [f"{reached} 5 m × 6.25 m{took}"]
    excavated = {"static": settled | {"steps": 900, "before": settled}}
    assert disk_outcome(elastic | excavated) == [
        f"static stage before the excavation: {steps}",
        f"static stage after the excavation: 900 steps, unbalanced force ratio 9.8e-06{took} for all stages",
    ]

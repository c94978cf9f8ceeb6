"""The elastic law in place of a history-dependent one, where the body remains elastic."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from plane_motion import recorded
from small_cases import PUSHED, around, small

from dembound.accuracy.estimate import advise
from dembound.accuracy.of_disks.law import RESERVE, ElasticTwin, elastic_twin
from dembound.accuracy.runner import SHORT, Runner
from dembound.casefile.disks import DiskCase
from dembound.kinds import with_changes
from dembound.running import plan

CONFINED: dict[str, Any] = PUSHED | {
    "packing": {"pattern": "A", "size": [20.0, 12.0], "radius": 0.25},
    "material": PUSHED["material"] | {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e6, "pb_coh": 2e6},
    "static": {"stress": [-1e6, -1e6, 0.0]},
    "boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom", "top")},
    "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 0.02}},
    "load": [{"name": "hit", "force": [0.0, 1e6], "region": [9.0, 5.0, 11.0, 7.0], "wave": "push"}],
    "monitor": [{"name": "beside", "position": [14.75, 6.25]}],
    "run": {"duration": 0.035},
}
"""A body under a stress at rest, in which a force sends S waves sideways."""


ON_THE_GROUND = {"boundary": around("roller")}
STEADY = {key: value for key, value in CONFINED["load"][0].items() if key != "wave"} | {"name": "steady"}


def confined(changes: dict[str, Any] | None = None) -> DiskCase:
    return small(CONFINED, changes=changes)


def twin_of(case: DiskCase, most: float = SHORT, kept: tuple[str, ...] = ()) -> ElasticTwin | None:
    return elastic_twin(case, plan(case), most, kept, Runner())


@cache
def own_twin() -> ElasticTwin:
    return twin_of(confined())


def test_the_elastic_law_replaces_another_that_is_never_needed() -> None:
    twin = own_twin()
    assert twin.case.material.law == "elastic"
    assert twin.case.material.pb_ten is None
    assert twin.case.load == confined().load
    assert twin.case.static is None  # whose stress does nothing to the motion of an elastic body
    assert twin.diameter == 0.5  # that of the case itself, which costs little
    assert 1.0 < twin.factor < 20.0
    assert twin_of(confined({"wave.push.amplitude": 1.1 * twin.factor})) is None  # larger waves leave it


@pytest.mark.slow
def test_with_larger_disks_more_is_needed() -> None:
    few = 2000.0  # particle-steps, less than the largest disks take that resolve the wave
    larger = twin_of(confined({"wave.push.amplitude": 0.1}), most=few)
    assert larger.diameter == pytest.approx(4.0 / 3.0)
    amplitude = 0.1 * larger.factor * 0.5 / larger.diameter / RESERVE
    assert twin_of(confined({"wave.push.amplitude": 0.95 * amplitude}), most=few) is not None
    assert twin_of(confined({"wave.push.amplitude": 1.05 * amplitude}), most=few) is None
    # smaller disks are nearer to the limits
    for factor, diameter, holds in ((1.1, 1.0, True), (0.9, 1.0, False), (1.1, 2.0, False), (2.1, 2.0, True)):
        assert ElasticTwin(own_twin().case, own_twin().planned, factor, 1.0, 0.0).holds(diameter) is holds
    for factor, holds in ((3.9, False), (4.1, True)):
        assert ElasticTwin(own_twin().case, own_twin().planned, factor, 1.0, 0.0).holds(0.5) is holds


@pytest.mark.parametrize(
    "changes",
    [
        {"material": PUSHED["material"] | {"law": "elastic", "fric": 0.5}},
        {"material.elastic_start": False},
        {"material.damp": 0.1},
        {"hole": [{"name": "h", "type": "circle", "centre": [5.0, 5.0], "radius": 2.0}]},
        {"load": [STEADY, *CONFINED["load"]], "static": ON_THE_GROUND},
    ],
)
def test_where_it_is_not_known_the_law_remains(changes: dict[str, Any]) -> None:
    assert twin_of(confined(changes)) is None


def test_the_stress_at_rest_that_turns_with_the_disks_is_counted() -> None:
    """Without the elastic start a law with updated geometry differs by this stress, by a third or more."""
    twin = own_twin()
    fixed = {"run.time_step": 0.9 * plan(confined()).time_step}
    full = confined({**fixed, "material.elastic_start": False})
    elastic = with_changes(twin.case, fixed)
    own, other = (recorded(case)["beside"] for case in (elastic, full))
    scene = plan(elastic).scene
    (cause,) = twin.causes(scene, {"beside": own})
    for quantity in ("velocity", "displacement"):
        difference = own.values[quantity] - other.values[quantity]
        true = float(np.linalg.norm(difference) / np.linalg.norm(own.values[quantity]))
        expected = cause.parts["beside"][quantity]
        assert isinstance(expected, float)
        assert 0.3 < true / expected < 1.0
    assert ElasticTwin(twin.case, twin.planned, 2.0, 0.5, 0.0).causes(scene, {"beside": own}) == []


def test_what_turns_is_the_given_stress_and_the_weight() -> None:
    """1 MPa; 2,500 kg/m³ under 10 m/s² over 12 m."""
    assert own_twin().stress == 1e6
    weight = {"name": "weight", "acceleration": [0.0, -10.0]}
    changes = {"load": [*CONFINED["load"], weight], "static": ON_THE_GROUND, "material.contact_share": 0.0}
    heavy = twin_of(confined(changes))
    assert heavy.stress == pytest.approx(2500.0 * 10.0 * 12.0)
    assert heavy.case.static is not None  # balances the weight
    still = twin_of(confined({"material.geometry": "reference"}))
    assert still.stress == 0.0


@pytest.mark.slow
def test_the_given_law_is_chosen_where_what_turns_is_too_much() -> None:
    """Under 10 MPa the elastic law has an error of 1.3 p/ρc_p² = 0.5 % or more."""
    case = confined({"static.stress": [-1e7, -1e7, 0.0], "run.duration": 0.02})
    advice = advise(case, (0.4, 0.003), kept=["boundary", "packing", "run"])
    other, found = advice.best[0.4], advice.best[0.003]
    assert found.case.material.law == "linearpbond"
    assert found.case.static is not None
    assert other.case.material.law == "elastic"
    assert other.holds(0.4)
    assert "the elastic law, which holds up to" in other.choice.name
    assert any(line.startswith("material = ") for line in other.choice.toml)
    assert advice.given.case == case

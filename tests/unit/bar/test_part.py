"""Steps of a bar: changes by its method, their cost, and reports."""

import numpy as np
import pytest

from dembound.bar.scene import BarPart, build_bar
from dembound.motion.simulation import Simulation

EPS = np.finfo(float).eps
UNIT = 0.025 / 1000.0
"""Δx/c, s."""
METHODS = {
    "finite_difference": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "switch": {"type": "switch", "horizon": 3},
    "patch": {"type": "patch", "horizon": 3, "reach": 1},
}


@pytest.fixture(params=METHODS.values(), ids=METHODS.keys())
def method(request) -> dict:
    return request.param


@pytest.fixture
def simulation(spalling):
    """Makes simulations of the spalling bar at a Courant number."""

    def make(courant: float = 0.9, probes: tuple[int, ...] = (), **changes: object) -> Simulation:
        return Simulation(build_bar(spalling(changes)), courant * UNIT, np.array(probes, dtype=np.int64))

    return make


def part_of(simulation: Simulation) -> BarPart:
    """The bar of a simulation, its only part."""
    (part,) = simulation.system.parts
    assert isinstance(part, BarPart)
    return part


def test_a_run_may_be_cut_anywhere_and_every_break_is_reported_once(simulation, method: dict) -> None:
    whole, run = (simulation(probes=(20, 35), method=method) for _ in range(2))
    records, reported = [], []
    record = whole.advance(5)
    alive = {"peridynamics": 40 + 39 + 38}.get(method["type"], 40)
    assert part_of(whole).bond_updates == 5 * alive  # what pulls
    record = np.concatenate([record, whole.advance(65)])
    for steps in (1, 9, 30, *30 * [1]):  # whatever step it is that ends a block
        records.append(run.advance(steps))
        reported.append(run.system.take_cracks(run.state.step))
        assert run.state.step - steps <= reported[-1].step.min(initial=run.state.step - steps)
        assert reported[-1].step.max(initial=0) < run.state.step
    assert np.array_equal(np.concatenate(records), record)
    assert np.array_equal(run.state.displacement, whole.state.displacement)
    assert whole.state.laws == run.state.laws

    assert len(run.system.take_cracks(run.state.step).step) == 0
    steps, pairs = part_of(whole).bonds.breaks(0)
    assert len(steps) > 0
    assert np.array_equal(np.concatenate([cracks.step for cracks in reported]), steps)
    assert np.array_equal(np.concatenate([cracks.pair for cracks in reported]), pairs)
    for cracks in reported:
        np.testing.assert_allclose(cracks.position[:, 0], 0.025 * cracks.pair.mean(axis=1), rtol=8 * EPS)
        assert not cracks.shear.any()

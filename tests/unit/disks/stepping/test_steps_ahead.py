"""Two steps of damped ground in one sweep beside one after the other."""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.disks.stepping import steps_ahead
from dembound.motion.simulation import Simulation

GRAINS = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 8.0], "size": [640.0, 8.0]}
CASES = {
    "grains in layers": {"packing": GRAINS, "layer": [{"thickness": 2.2, "quality_factor": 50.0}, {}]},
    "lattice": {"packing": {"pattern": "A", "radius": 0.25, "size": [400.0, 8.0]}},
}
"""Crossing contacts and strays; neighbours in two blocks of eight."""

BODY = {
    "boundary": {"right": {"type": "viscous"}},
    "wave": {},
    "motion.held": [],
    "monitor": [],
    "material.quality_factor": 5.0,
}


def moved(case, monkeypatch, least: int) -> tuple[Simulation, list[np.ndarray]]:
    """A body after 301 steps, past the one at which memories fade, in calls of several lengths, and its record."""
    monkeypatch.setattr(steps_ahead, "LEAST_BLOCKS", least)
    monkeypatch.setattr(steps_ahead, "LEAST_SHARE", 0.1)
    scene = build(case)
    simulation = Simulation(scene, choose_step(scene)[0], probes=np.array([scene.count // 2]))
    random = np.random.default_rng(2)
    simulation.state.velocity = random.normal(0.0, 1e-3, (3, scene.count)) * scene.moves
    return simulation, [simulation.advance(steps) for steps in (37, 1, 2, 260, 1)]


@pytest.mark.parametrize("name", CASES)
def test_sweeps_of_two_steps_give_the_same_bits(bar, monkeypatch, name: str) -> None:
    case = bar(BODY | CASES[name])
    simulation, records = moved(case, monkeypatch, 1)
    other, expected = moved(case, monkeypatch, 10**9)
    early = simulation.system.parts[-1].memories.arrays.ahead.early

    assert 0.1 * early.size < early.sum() < early.size
    assert not other.system.parts[-1].memories.arrays.ahead.early.any()
    assert all(np.array_equal(one, two) for one, two in zip(records, expected, strict=True))
    for array, values in other.system.saved_arrays().items():
        assert np.array_equal(simulation.system.saved_arrays()[array], values), array
    assert np.array_equal(simulation.state.u, other.state.u)
    assert np.array_equal(simulation.state.v, other.state.v)
    # the same terms, summed in another order: each of 301 steps is rounded by some 1e-15 of all that was taken
    assert simulation.state.work[:, 1] == pytest.approx(other.state.work[:, 1], rel=1e-12)

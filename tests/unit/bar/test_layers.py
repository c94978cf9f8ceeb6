"""Layers beyond the ends of a bar: the bar with them is a longer bar whose waves decay there."""

import numpy as np
import pytest

from dembound.bar.scene import build_bar
from dembound.errors import CaseError
from dembound.motion.simulation import Simulation

NODES = {"left": 9, "right": 14}
METHODS = {
    "finite differences": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "corrected ends": {"type": "peridynamics", "horizon": 3, "corrected_ends": True},
}


def ends(**keys) -> dict:
    return {f"boundary.{side}": {"type": "matched_layer", "nodes": nodes} | keys for side, nodes in NODES.items()}


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_motion_without_decay_is_that_of_a_longer_bar(spalling, method: dict) -> None:
    """Noise in the bar, until its waves have returned from the ends of the longer bar: five steps of three nodes.

    To the rounding of sums of some ten forces in a step. Stresses within a horizon of a layer include the layer's
    bonds, at the same step.
    """
    common = {"method": method, "bar.strength": 1e12, "load": []}
    short = build_bar(spalling(common | ends(reflection=1.0 - 1e-15)))  # with which nothing decays
    longer = build_bar(spalling(common | {"bar.length": 0.025 * (40 + sum(NODES.values()))}))
    step, places = 0.5 * longer.step_limit(), np.array([1, 2, 38, 39])
    noise = np.random.default_rng(2).standard_normal(short.count)
    moved, stresses = [], []
    for scene, first in ((short, 0), (longer, NODES["left"])):
        simulation = Simulation(scene, step, places + first)
        velocity = np.zeros((3, scene.count))
        velocity[0, first : first + short.count] = noise
        simulation.state.velocity = velocity
        simulation.state.displacement = step * velocity  # from zero a step ago, as the bonds of a layer at rest
        stresses.append(simulation.advance(4)[:, :, 6])
        moved.append(simulation.state.displacement[0, first : first + short.count])
    np.testing.assert_allclose(moved[0], moved[1], rtol=0.0, atol=60 * 2.3e-16 * np.abs(moved[1]).max())
    np.testing.assert_allclose(stresses[0], stresses[1], rtol=0.0, atol=1e-12 * np.abs(stresses[1]).max())
    assert np.abs(stresses[1]).max() > 0.0


RANGES = [{"name": "striker", "length": 0.25, "velocity": 5.0}, {"name": "rock", "length": 0.75}]


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (
            {"method": {"type": "peridynamics", "horizon": 5}},
            "boundary.left.nodes: is 9, must be at least 10, twice method.horizon",
        ),
        (
            {"bar": {"spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0, "range": RANGES}},
            "boundary.left.type: its layer is at rest, but range striker beside it has a velocity",
        ),
    ],
    ids=["shorter than two horizons", "beside a moving range"],
)
def test_layers_that_cannot_be_are_refused(spalling, changes: dict, problem: str) -> None:
    with pytest.raises(CaseError) as error:
        spalling(changes | ends())
    assert error.value.problems == [problem]

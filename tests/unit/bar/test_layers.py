"""Layers beyond the ends of a bar: the bar with them is a longer bar whose waves decay there."""

import numpy as np
import pytest

from dembound.bar.layers import continued
from dembound.bar.scene import build_bar
from dembound.boundaries.matched_layer import usual_reflection
from dembound.errors import CaseError
from dembound.motion.simulation import Simulation

NODES = {"left": 9, "right": 14}
METHODS = {
    "finite differences": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "corrected ends": {"type": "peridynamics", "horizon": 3, "corrected_ends": True},
}
STILL = 1.0 - 1e-15
"""R0 with which nothing decays."""


def ends(**keys) -> dict:
    return {f"boundary.{side}": {"type": "matched_layer", "nodes": nodes} | keys for side, nodes in NODES.items()}


@pytest.fixture(params=METHODS.values(), ids=METHODS.keys())
def pair(request, spalling):
    """A bar of 41 nodes with layers in which nothing decays, and one that is as much longer; its shift in nodes."""
    common = {"method": request.param, "bar.strength": 1e12, "load": []}
    short = build_bar(spalling(common | ends(reflection=STILL)))
    longer = build_bar(spalling(common | {"bar.length": 0.025 * (40 + sum(NODES.values()))}))
    return short, longer


def test_bonds_and_masses_are_those_of_a_longer_bar(pair) -> None:
    """But for its ends, which are half cells and soft: 4 nodes, a horizon and one."""
    short, longer = pair
    bonds, other = (scene.case.method.begin(scene.rod) for scene in pair)
    bands, mass, held = continued(short.layers, bonds.stiffness(), short.mass, np.array([2]))
    inside = slice(4, -7)
    scale = np.abs(other.stiffness()).max()
    np.testing.assert_allclose(bands[:, inside], other.stiffness()[:, inside], rtol=0.0, atol=1e-13 * scale)
    np.testing.assert_allclose(mass[1:-1], longer.mass[1:-1], rtol=1e-14)
    assert held.tolist() == [2 + NODES["left"]]


def test_motion_without_decay_is_that_of_a_longer_bar(pair) -> None:
    """Of noise in the bar, until its waves have been at the ends of the longer one and back: five steps of three nodes.

    To the rounding of sums of some ten forces in a step.
    """
    short, longer = pair
    step = 0.5 * longer.step_limit()
    noise = np.random.default_rng(2).standard_normal(short.count)
    moved = []
    for scene, first in ((short, 0), (longer, NODES["left"])):
        simulation = Simulation(scene, step)
        velocity = np.zeros((3, scene.count))
        velocity[0, first : first + short.count] = noise
        simulation.state.velocity = velocity
        simulation.state.displacement = step * velocity  # from zero a step ago, as the bonds of a layer at rest
        simulation.run(4)
        moved.append(simulation.state.displacement[0, first : first + short.count])
    np.testing.assert_allclose(moved[0], moved[1], rtol=0.0, atol=60 * 2.3e-16 * np.abs(moved[1]).max())


def test_probes_beside_a_layer_see_all_bonds(pair) -> None:
    """The stress recorded within a horizon of the layer has the layer's bonds, at the step of all others."""
    short, longer = pair
    step = 0.5 * longer.step_limit()
    places = np.array([1, 2, 38, 39])
    found = []
    for scene, shift in ((short, 0), (longer, NODES["left"])):
        simulation = Simulation(scene, step, places + shift)
        velocity = np.zeros((3, scene.count))
        velocity[0, [5 + shift, 35 + shift]] = 1.0, -2.0
        simulation.state.velocity = velocity
        simulation.state.displacement = step * velocity  # from zero a step ago, as the bonds of a layer at rest
        found.append(simulation.advance(4)[:, :, 6])  # the ends are 14 nodes away, five steps
    np.testing.assert_allclose(found[0], found[1], rtol=0.0, atol=1e-12 * np.abs(found[1]).max())
    assert np.abs(found[1]).max() > 0.0


def test_the_right_nodes_are_bonded_to_layers(spalling) -> None:
    scene = build_bar(spalling({"method": METHODS["peridynamics"], "bar.strength": 1e12} | ends()))
    assert {side: layer.inner.tolist() for side, layer in scene.layers.items()} == {
        "left": [2, 1, 0],
        "right": [38, 39, 40],
    }
    assert {side: nodes.tolist() for side, nodes in scene.tied.items()} == {"left": [0, 1, 2], "right": [38, 39, 40]}
    left = scene.layers["left"]
    assert left.layer.reflection == usual_reflection(9)
    assert left.length == pytest.approx(9 * 0.025)
    assert np.count_nonzero(left.node_rates) == 9


def test_a_layer_shorter_than_two_horizons_is_refused(spalling) -> None:
    method = {"type": "peridynamics", "horizon": 5}
    with pytest.raises(CaseError) as error:
        spalling({"method": method} | ends())
    assert error.value.problems == ["boundary.left.nodes: is 9, must be at least 10, twice method.horizon"]


def test_springs_in_a_layer_need_no_more(spalling) -> None:
    scene = build_bar(spalling({"method": {"type": "patch", "horizon": 5}} | ends()))
    assert [len(layer.inner) for layer in scene.layers.values()] == [1, 1]


def test_a_moving_range_beside_a_layer_is_refused(spalling) -> None:
    ranges = [{"name": "striker", "length": 0.25, "velocity": 5.0}, {"name": "rock", "length": 0.75}]
    bar = {"spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0, "range": ranges}
    with pytest.raises(CaseError) as error:
        spalling({"bar": bar} | ends())
    assert error.value.problems == [
        "boundary.left.type: its layer is at rest, but range striker beside it has a velocity"
    ]

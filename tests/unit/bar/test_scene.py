"""A bar's case as a scene: nodes, masses, ends, loads, and the wave that enters."""

import numpy as np
import pytest
from small_cases import problems_in

from dembound.bar.scene import build_bar, entering_pressure
from dembound.errors import CaseError
from dembound.machine import Memory
from dembound.motion import memory
from dembound.motion.simulation import Simulation

EPS = np.finfo(float).eps
LINE = {"bar.diameter": 0.2, "load": []}
SECTION = 0.01 * np.pi
"""Area of a round bar of that diameter, m²."""


def test_nodes_stand_from_end_to_end_with_half_a_mass_there(spalling) -> None:
    places = {"start": 0.0, "below": 0.512, "above": 0.513, "end": 1.0}
    monitors = [{"name": name, "position": place} for name, place in places.items()]
    scene = build_bar(spalling({**LINE, "monitor": monitors}))

    np.testing.assert_allclose(scene.positions[:, 0], np.linspace(0.0, 1.0, 41), rtol=2 * EPS)
    assert not scene.positions[:, 1].any()
    assert scene.size.tolist() == [1.0, 0.0]
    assert scene.rod.ranges[0].section == pytest.approx(SECTION, rel=2 * EPS)
    assert (scene.rod.ranges[0].modulus, scene.rod.ranges[0].critical_stretch) == (2.5e9, 8e6 / 2.5e9)
    whole = 2500.0 * SECTION * 0.025
    np.testing.assert_allclose(scene.mass, [0.5 * whole, *39 * [whole], 0.5 * whole], rtol=4 * EPS)
    np.testing.assert_allclose(scene.inertia, scene.mass * 0.025**2 / 12.0, rtol=4 * EPS)
    assert scene.free.tolist() == [1.0, 0.0, 0.0]
    assert scene.monitors == {"start": 0, "below": 20, "above": 21, "end": 40}
    for edge, side, node, place in zip(scene.edges.values(), ("left", "right"), (0, 40), (0.0, 1.0), strict=True):
        assert (edge.side, edge.nodes.tolist(), edge.positions.tolist()) == (side, [node], [[place, 0.0]])
        assert (edge.diameter_sum_ratio, edge.length) == (1.0, pytest.approx(SECTION, rel=2 * EPS))


@pytest.mark.parametrize("nodes", [1, 3, 41])
@pytest.mark.parametrize(("side", "way"), [("left", 1.0), ("right", -1.0)])
def test_a_load_is_spread_in_proportion_to_volume(spalling, side: str, way: float, nodes: int) -> None:
    push = {"name": "hit", "pressure": 12e6, "side": side, "nodes": nodes, "wave": "hit"}
    scene = build_bar(spalling({**LINE, "load": [push]}))
    # at the crest of the wave, where its factor is 1
    (force,) = scene.supports.sample(np.array([2e-4]), 1.0)

    expected = np.arange(nodes) if side == "left" else np.arange(41 - nodes, 41)
    assert scene.supports.node.tolist() == expected.tolist()
    assert force.sum() == pytest.approx(way * 12e6 * SECTION, rel=nodes * EPS)
    np.testing.assert_allclose(force / scene.mass[expected], force[0] / scene.mass[expected[0]], rtol=8 * EPS)
    assert not scene.supports.component.any()


def test_ends_stand_for_more_of_the_bar(spalling) -> None:
    ends = {"boundary.left": {"type": "fixed"}, "boundary.right": {"type": "viscous", "beta_p": 0.9}}
    scene = build_bar(spalling({**LINE, **ends}))
    matched = 2500.0 * 1000.0 * SECTION

    assert scene.supports.node.tolist() == [0, 40]
    assert scene.supports.prescribed.tolist() == [True, False]
    assert scene.supports.damping[1] == pytest.approx(0.9 * matched, rel=8 * EPS)
    assert not scene.supports.stiffness.any()
    # attenuation acts on supported nodes through their table: 2αc, of half a mass; it adds no supports
    attenuated = build_bar(spalling({**LINE, "boundary.right": {"type": "viscous"}, "bar.attenuation": 0.5}))
    assert attenuated.case.bar.drag_rate == pytest.approx(1000.0, rel=4 * EPS)
    expected = matched + 1000.0 * attenuated.mass[-1]
    assert attenuated.supports.damping.tolist() == pytest.approx([expected], rel=8 * EPS)


TIME = np.array([-1e-5, 5e-5, 2e-4, 4e-4])
SHAPE = np.array([0.0, 0.25, 1.0, 0.0])
"""An even triangle of 0.4 ms."""
DASHPOT = {"type": "viscous_input", "beta_p": 0.5}


@pytest.mark.parametrize(
    ("side", "end", "wave", "load"),
    [
        # of ρcA v = F − βρcA v + 2βρcA v_i, with ρc = 2.5e6 Pa·s/m
        ("left", DASHPOT, 2.5e6 * 2.0 * 0.5 / 1.5, 12e6 / 1.5),
        ("right", DASHPOT, 2.5e6 * 2.0 * 0.5 / 1.5, 12e6 / 1.5),
        ("right", {"type": "matched_layer"}, 2.5e6, 6e6),
    ],
)
def test_a_dashpot_takes_its_part_of_a_load_and_lets_its_wave_in(spalling, side, end, wave, load) -> None:
    hit = {"name": "hit", "pressure": 12e6, "wave": "hit", "side": side}
    velocity = 1.0 if side == "left" else -1.0  # inwards
    shape = {"type": "triangle", "amplitude": velocity, "rise": 2e-4, "fall": 2e-4}
    case = spalling({"load": [hit], f"boundary.{side}": end | {"wave_p": "in"}, "wave.in": shape})

    np.testing.assert_allclose(entering_pressure(case, side, TIME, loads=False), wave * SHAPE, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(entering_pressure(case, side, TIME), (wave + load) * SHAPE, rtol=1e-12, atol=1e-6)
    assert entering_pressure(case, side, np.zeros((2, 3))).shape == (2, 3)


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


LONG = {"method": {"type": "peridynamics", "horizon": 5}}
MOVING = {"bar": {"spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0, "range": RANGES}}


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (LONG, "boundary.left.nodes: is 9, must be at least 10, twice method.horizon"),
        (MOVING, "boundary.left.type: its layer is at rest, but range striker beside it has a velocity"),
    ],
)
def test_layers_that_cannot_be_are_refused(spalling, changes: dict, problem: str) -> None:
    assert problems_in(lambda: spalling(changes | ends())) == [problem]


def test_a_bar_too_large_is_refused_before_its_nodes_are_placed(spalling, monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(300e6, 250e6))
    said = r"^bar.spacing: 1,000,001 nodes with a horizon of 3 spacings need about \d+ MB of "
    with pytest.raises(CaseError, match=said):
        build_bar(spalling({"bar.spacing": 1e-6}))

"""A bar's case as a scene: nodes, masses, ends, loads and limits."""

import numpy as np
import pytest

from dembound.bar.scene import BarScene, build_bar
from dembound.exact.dispersion import courant_limit
from dembound.motion.supports import NodeSupports

EPS = np.finfo(float).eps
LINE = {"bar.diameter": 0.2, "load": []}
SECTION = 0.01 * np.pi
"""Area of a round bar of that diameter, m²."""
ENDS = {"boundary.left": {"type": "fixed"}, "boundary.right": {"type": "viscous"}}


def row(scene: BarScene, node: int) -> int:
    """Line of a node in the support table."""
    (found,) = np.flatnonzero(scene.supports.node == node)
    return int(found)


def test_nodes_stand_from_end_to_end(spalling) -> None:
    scene = build_bar(spalling(LINE))

    assert scene.count == 41
    np.testing.assert_allclose(scene.positions[:, 0], np.linspace(0.0, 1.0, 41), rtol=2 * EPS)
    assert not scene.positions[:, 1].any()
    assert scene.size.tolist() == [1.0, 0.0]
    assert scene.rod.ranges[0].section == pytest.approx(SECTION, rel=2 * EPS)
    assert (scene.rod.ranges[0].modulus, scene.rod.ranges[0].critical_stretch) == (2.5e9, 8e6 / 2.5e9)


def test_end_nodes_have_half_a_mass(spalling) -> None:
    scene = build_bar(spalling(LINE))
    whole = 2500.0 * SECTION * 0.025

    np.testing.assert_allclose(scene.mass, [0.5 * whole, *39 * [whole], 0.5 * whole], rtol=4 * EPS)
    np.testing.assert_allclose(scene.inertia, scene.mass * 0.025**2 / 12.0, rtol=4 * EPS)
    assert scene.free.tolist() == [1.0, 0.0, 0.0]


def test_edges_are_the_two_end_nodes(spalling) -> None:
    edges = build_bar(spalling(LINE)).edges

    assert list(edges) == ["left", "right"]
    for side, node, place in (("left", 0, 0.0), ("right", 40, 1.0)):
        assert edges[side].nodes.tolist() == [node]
        assert edges[side].positions.tolist() == [[place, 0.0]]
        assert edges[side].diameter_sum_ratio == 1.0
        assert edges[side].length == pytest.approx(SECTION, rel=2 * EPS)


def test_a_record_is_told_of_the_bar_and_its_ends(spalling) -> None:
    told = build_bar(spalling({"bar.attenuation": 0.3, "boundary.right": {"type": "viscous"}})).attributes

    assert told == {
        "density": 2500.0,
        "section": 1.0,
        "youngs_modulus": 2.5e9,
        "wave_speed": 1000.0,
        "attenuation": 0.3,
        "strength": [8e6, 8e6],
        "loaded": "left",
        "ends": ["free", "viscous"],
    }


def test_a_monitor_stands_at_the_nearest_node(spalling) -> None:
    places = {"start": 0.0, "below": 0.512, "above": 0.513, "end": 1.0}
    monitors = [{"name": name, "position": place} for name, place in places.items()]

    assert build_bar(spalling({"monitor": monitors})).monitors == {"start": 0, "below": 20, "above": 21, "end": 40}


@pytest.mark.parametrize("nodes", [1, 2, 3, 41])
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
    scene = build_bar(spalling({**LINE, **ENDS, "boundary.right.beta_p": 0.9}))

    assert scene.supports.node.tolist() == [0, 40]
    assert scene.supports.prescribed.tolist() == [True, False]
    assert scene.supports.damping[1] == pytest.approx(0.9 * 2500.0 * 1000.0 * SECTION, rel=8 * EPS)
    assert not scene.supports.stiffness.any()


def test_attenuation_acts_on_supported_nodes_through_their_table(spalling) -> None:
    scene = build_bar(spalling({**LINE, "boundary.right": {"type": "viscous"}, "bar.attenuation": 0.5}))

    # 2αc, of half a mass
    assert scene.case.bar.drag_rate == pytest.approx(1000.0, rel=4 * EPS)
    expected = 2500.0 * 1000.0 * SECTION + 1000.0 * scene.mass[-1]
    assert scene.supports.damping.tolist() == pytest.approx([expected], rel=8 * EPS)


def test_attenuation_adds_no_supports(spalling) -> None:
    scene = build_bar(spalling({**LINE, "bar.attenuation": 0.5}))

    assert len(scene.supports) == 0


def test_no_free_field_stands_beside_a_bar(spalling) -> None:
    scene = build_bar(spalling({"boundary.right": {"type": "viscous"}}))
    system = scene.system(1e-5)

    assert [part.nodes for part in system.parts] == [slice(0, 41)]
    assert system.ties == ()
    assert scene.twin is None
    supports = NodeSupports(scene, system.ties, 1e-5)
    assert supports.nodes.tolist() == [0, 1, 2, 40]
    assert supports.twin.tolist() == [-1, -1, -1, -1]
    assert not supports.follow.any()
    assert not scene.steady_load.any()


METHODS = {
    "finite_difference": ({"type": "finite_difference"}, 1.0),
    "peridynamics": ({"type": "peridynamics", "horizon": 3}, courant_limit(3)),
    "switch": ({"type": "switch", "horizon": 3}, 1.0),
    "patch": ({"type": "patch", "horizon": 3}, 1.0),
}


@pytest.mark.parametrize(("method", "courant"), METHODS.values(), ids=METHODS.keys())
def test_the_limit_is_that_of_the_stage_that_is_least_stable(spalling, method: dict, courant: float) -> None:
    scene = build_bar(spalling({"method": method}))
    limit = scene.step_limit()
    stages = [scene.stable_step(bonds) for bonds in scene.case.method.stages(scene.rod)]

    assert limit == min(stages)
    for bonds, stable in zip(scene.case.method.stages(scene.rod), stages, strict=True):
        assert scene.is_stable(bonds, limit * (1.0 - 1e-12))
        assert not scene.is_stable(bonds, stable * (1.0 + 1e-12))
    # that of an endless bar, but for ends 41 nodes apart: ¼(π/40)² at most
    assert limit * 1000.0 / 0.025 == pytest.approx(courant, rel=0.25 * (np.pi / 40) ** 2)


def test_held_ends_do_not_vibrate(spalling) -> None:
    held = {side: {"type": "fixed"} for side in ("left", "right")}
    short = {"bar.spacing": 0.5, "method": {"type": "finite_difference"}, "load": [], "boundary": held}
    scene = build_bar(spalling(short))

    # one node of m = ρAΔx on two springs EA/Δx: ω² = 2c²/Δx²
    assert scene.step_limit() == pytest.approx(2.0 / np.sqrt(2.0 * 1000.0**2 / 0.5**2), rel=8 * EPS)

"""The sides of a run: the division of forces at corners, and records of bars and of runs without measured sides."""

import numpy as np
import pytest
from small_cases import GRAINS, small

from dembound.boundaries.support import Edge
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.sides import _bearers
from dembound.motion.simulation import Simulation


def edge(side: str, nodes: list[int], diameters: list[float]) -> Edge:
    return Edge(side, np.array(nodes), np.zeros((len(nodes), 2)), np.array(diameters), sum(diameters))


def borne(edges: list[Edge], force: np.ndarray, known: dict | None = None) -> np.ndarray:
    """Forces (s, 2) of every side, of forces (2, n) on nodes."""
    return np.array([(share * force[:, node]).sum(axis=1) for node, share in _bearers(edges, known or {})])


LEFT, BOTTOM = edge("left", [0, 1, 2], [1.0, 2.0, 3.0]), edge("bottom", [2, 3, 4], [3.0, 1.0, 1.0])


def test_a_uniform_stress_is_taken_apart_at_a_corner() -> None:
    stress = np.array([[-3.0, 0.5], [0.5, -7.0]])
    force = np.zeros((2, 5))
    for each, outward in ((LEFT, [-1.0, 0.0]), (BOTTOM, [0.0, -1.0])):
        force[:, each.nodes] += np.outer(stress @ outward, each.diameters)
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force), [[18.0, -3.0], [-2.5, 35.0]], rtol=1e-14)


@pytest.mark.parametrize("recorded", [0.0, 4.0])
def test_known_forces_of_sides_are_taken_apart_as_they_were_put_together(recorded: float) -> None:
    """Also where a side is recorded with another force than acts by it: of the 4 N of node 2 by the left side."""
    left, bottom = np.array([[1.0, 4.0], [0.0, -2.0]]), np.array([[6.0, 0.0], [2.0, 7.0]])
    known = {
        "left": (np.array([0, 2]), left, left),
        "bottom": (np.array([2, 4]), bottom, bottom + np.array([[recorded, 0.0], [0.0, 0.0]])),
    }
    force = np.zeros((2, 5))
    force[:, [0, 2]] += left
    force[:, [2, 4]] += bottom
    force[:, 3] = [0.5, 0.25]  # of a node of one side alone
    # where two forces cancel, here along y, what there is belongs to the side along whose normal it is
    expected = [[5.0, 0.0], [6.5 + recorded, 7.25]]
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force, known), expected, rtol=1e-14)


@pytest.mark.parametrize("cuts", [(40,), (1, 2, 8, 9, 23, 24, 40)])
def test_samples_are_those_of_every_nth_step_however_the_run_is_cut(bar, cuts) -> None:
    scene = build(bar())
    step = choose_step(scene)[0]
    unwatched = Simulation(scene, step)
    assert unwatched.sides is None  # only if it is asked to
    assert unwatched.side_samples.record.shape[1:] == (0, 5)
    every, eighth = (Simulation(scene, step, side_stride=stride) for stride in (1, 8))
    every.run(40)
    steps, samples = [], []
    for cut in cuts:
        eighth.run(cut)
        steps += eighth.side_samples.steps.tolist()
        samples.append(eighth.side_samples.record)
    assert steps == [0, 8, 16, 24, 32]
    assert np.array_equal(np.concatenate(samples), every.side_samples.record[::8])
    assert np.array_equal(eighth.state.side_work, every.state.side_work)
    assert np.any(every.side_samples.record[-1])
    assert np.all(every.state.side_work[:, :, 0].any(axis=1))


def test_the_rest_at_a_corner_is_of_the_side_along_whose_normal_it_is() -> None:
    force = np.zeros((2, 5))
    force[:, 2] = [10.0, 20.0]
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force), [[10.0, 0.0], [0.0, 20.0]], rtol=0.0, atol=1e-14)


def test_the_mean_motion_of_a_side_is_that_by_diameters() -> None:
    scene = build(small(GRAINS))
    sides = Simulation(scene, choose_step(scene)[0], side_stride=1).sides
    datum = np.random.default_rng(5).standard_normal((3, scene.count))
    for name, moved in zip(sides.names, sides.origin(datum), strict=True):
        edge = scene.edges[name]
        np.testing.assert_allclose(moved, np.average(datum[:, edge.nodes], axis=1, weights=edge.diameters), rtol=1e-12)

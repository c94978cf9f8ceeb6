"""Loads on the particles of a scene: where they act and how hard."""

import numpy as np
import pytest

from dembound.casefile.disks.load import Load
from dembound.disks.loads import forces_of
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly

MASS = np.array([1.0, 2.0, 3.0, 4.0])


@pytest.fixture
def row() -> Assembly:
    """Four disks along x at 1, 2, 3 and 4 m, with radii in m like their numbers."""
    numbers = np.arange(4, dtype=np.int32)
    return Assembly(
        positions=np.column_stack([numbers + 1.0, np.zeros(4)]),
        radii=numbers + 1.0,
        brick_particle=numbers,
        tile=np.zeros((4, 2), np.int32),
        pairs=np.zeros((0, 2), np.int32),
        contact_type=numbers[:0],
        copies=(1, 1),
        size=np.ones(2),
        extent=np.ones(2),
    )


def test_a_force_is_shared_by_the_masses(row: Assembly) -> None:
    load = Load(name="a", force=(5.0, -10.0), region=(1.5, -1.0, 3.5, 1.0))
    nodes, forces = forces_of(load, row, MASS)

    # masses as 2 to 3
    assert nodes.tolist() == [1, 2]
    np.testing.assert_allclose(forces, [[2.0, -4.0], [3.0, -6.0]], rtol=1e-15)


def test_an_acceleration_acts_on_every_mass(row: Assembly) -> None:
    nodes, forces = forces_of(Load(name="a", acceleration=(0.0, -10.0)), row, MASS)

    assert nodes.tolist() == [0, 1, 2, 3]
    assert np.array_equal(forces, np.column_stack([np.zeros(4), -10.0 * MASS]))


def test_a_position_means_the_nearest_disk(row: Assembly) -> None:
    nodes, forces = forces_of(Load(name="a", force=(7.0, 0.0), position=(2.6, 5.0)), row, MASS)

    assert (nodes.tolist(), forces.tolist()) == ([2], [[7.0, 0.0]])


def test_disks_centred_on_the_rim_of_a_region_are_in_it(row: Assembly) -> None:
    nodes, _ = forces_of(Load(name="a", acceleration=(1.0, 0.0), region=(2.0, 0.0, 3.0, 1.0)), row, MASS)

    assert nodes.tolist() == [1, 2]


def test_a_region_without_disks_is_refused(row: Assembly) -> None:
    with pytest.raises(CaseError, match=r"load\.far: no particle is centred in its region \[8\.0, "):
        forces_of(Load(name="far", force=(1.0, 0.0), region=(8.0, 0.0, 9.0, 1.0)), row, MASS)


def loaded(bar, *loads: dict, **changes: object):
    return build(bar({"load": list(loads), "motion.held": [], **changes}))


PULL = {"name": "pull", "force": [2.0, 3.0], "position": [9.9, 0.9]}
WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}


def test_steady_loads_add_up(bar) -> None:
    scene = loaded(bar, PULL, WEIGHT)
    expected = np.zeros((3, scene.count))
    expected[1] = -9.81 * scene.mass
    expected[:2, int(np.argmax(scene.assembly.positions.sum(axis=1)))] += [2.0, 3.0]

    assert np.array_equal(scene.steady_load, expected)


def test_a_load_with_a_wave_follows_it_and_is_not_steady(bar) -> None:
    scene = loaded(bar, {**PULL, "force": [0.0, 3.0], "wave": "pulse"})
    node = int(np.argmax(scene.assembly.positions.sum(axis=1)))
    times = np.array([0.0, 0.0025, 0.005])
    driven = scene.supports.sample(times, 1e-4)[:, (scene.supports.node == node) & (scene.supports.component == 1)]

    assert not scene.steady_load.any()
    # ½M(1 − cos 2πt/T) with M = 0.5, T = 0.01: 0, 0.25, 0.5, as pure numbers; cosines of multiples of π/2
    np.testing.assert_allclose(driven.sum(axis=1), 3.0 * np.array([0.0, 0.25, 0.5]), atol=1e-15)
    # no other row is driven at the right end, and none along x there
    right = (scene.supports.component == 0) & (scene.supports.node == node)
    assert not scene.supports.sample(times, 1e-4)[:, right].any()


@pytest.mark.parametrize("wave", [{}, {"wave": "flat"}])
def test_half_masses_take_half_the_body_force(bar, wave: dict) -> None:
    flat = {"type": "constant", "amplitude": 1.0}
    scene = loaded(bar, {**WEIGHT, **wave}, **{"boundary.right.half_mass": True, "wave.flat": flat})
    along_y = scene.supports.component == 1
    force = scene.steady_load[1].copy()
    force[scene.supports.node[along_y]] += scene.supports.sample(np.array([1.0]), 0.0)[0, along_y]

    # 625 kg, and half of it at the right end
    assert set(np.round(scene.mass, 9)) == {625.0, 312.5}
    np.testing.assert_allclose(force, -9.81 * scene.mass, rtol=1e-15)

"""Loads on the particles of a scene: where they act and how hard."""

from types import SimpleNamespace

import numpy as np
import pytest

from dembound.casefile.disks.load import Load
from dembound.disks.scene import build
from dembound.disks.supports import forces_of
from dembound.errors import CaseError
from dembound.kinds.disks.facts import disk_facts
from dembound.packings.tiling import Assembly

MASS = np.array([1.0, 2.0, 3.0, 4.0])


@pytest.fixture
def row() -> SimpleNamespace:
    """A scene of four disks along x at 1, 2, 3 and 4 m, with radii in m like their numbers."""
    numbers = np.arange(4, dtype=np.int32)
    assembly = Assembly(
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
    return SimpleNamespace(assembly=assembly, mass=MASS, outside=None)


def test_a_force_is_shared_by_the_masses_on_all_of_which_an_acceleration_acts(row: SimpleNamespace) -> None:
    load = Load(name="a", force=(5.0, -10.0), region=(1.5, -1.0, 3.5, 1.0))
    nodes, forces = forces_of(load, row)

    # masses as 2 to 3
    assert nodes.tolist() == [1, 2]
    np.testing.assert_allclose(forces, [[2.0, -4.0, 0.0], [3.0, -6.0, 0.0]], rtol=1e-15)
    nodes, forces = forces_of(Load(name="a", acceleration=(0.0, -10.0)), row)
    assert nodes.tolist() == [0, 1, 2, 3]
    assert np.array_equal(forces, np.column_stack([np.zeros(4), -10.0 * MASS, np.zeros(4)]))


def test_a_position_means_the_nearest_disk_and_a_region_those_centred_up_to_its_rim(row: SimpleNamespace) -> None:
    nodes, forces = forces_of(Load(name="a", force=(7.0, 0.0), position=(2.6, 5.0)), row)
    assert (nodes.tolist(), forces.tolist()) == ([2], [[7.0, 0.0, 0.0]])
    half_way = forces_of(Load(name="a", force=(7.0, 0.0), position=(2.5 + 1e-12, 5.0)), row)[0]
    assert half_way.tolist() == [1]  # the left one, as for monitors
    rim = forces_of(Load(name="a", acceleration=(1.0, 0.0), region=(2.0, 0.0, 3.0, 1.0)), row)[0]
    assert rim.tolist() == [1, 2]
    with pytest.raises(CaseError, match=r"load\.far: no particle is centred in its region \[8\.0, "):
        forces_of(Load(name="far", force=(1.0, 0.0), region=(8.0, 0.0, 9.0, 1.0)), row)


def loaded(bar, *loads: dict, **changes: object):
    return build(bar({"load": list(loads), "motion.held": [], **changes}))


PULL = {"name": "pull", "force": [2.0, 3.0], "position": [9.9, 0.9]}
WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}


def test_a_load_with_a_wave_follows_it_and_is_not_steady(bar) -> None:
    scene = loaded(bar, {**PULL, "force": [0.0, 3.0], "wave": "pulse"})
    node = int(np.argmax(scene.assembly.positions.sum(axis=1)))
    times = np.array([0.0, 0.0025, 0.005])
    driven = scene.supports.sample(times, 1e-4)[:, (scene.supports.node == node) & (scene.supports.component == 1)]

    assert not scene.steady_load.any()
    # ½M(1 − cos 2πt/T) with M = 0.5, T = 0.01: 0, 0.25, 0.5, as pure numbers; cosines of multiples of π/2
    np.testing.assert_allclose(driven.sum(axis=1), 3.0 * np.array([0.0, 0.25, 0.5]), atol=1e-15)


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


SURROUNDED = {
    "packing": {"pattern": "A", "size": [8.0, 4.0], "radius": 0.25},
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
    "outside": {"element": 2.0, "margin": 2},
}
"""Elements of 2 m; absorbing ones begin at x = −4 m, 12 m and y = −4 m."""


@pytest.mark.parametrize(("first", "last"), [(9.1, 11.3), (-4.0, 0.0)])
def test_a_steady_force_on_the_continuum_is_a_traction_on_its_surface(bar, first: float, last: float) -> None:
    scene = loaded(bar, {"name": "house", "force": [2e3, -5e3], "region": [first, 3.0, last, 4.0]}, **SURROUNDED)
    force, (x, y) = scene.steady_load, scene.positions.T
    pushed = np.flatnonzero(force.any(axis=0))

    assert pushed.min() >= scene.disk_count
    assert (y[pushed] == 4.0).all()
    np.testing.assert_allclose(force.sum(axis=1), [2e3, -5e3, 0.0], rtol=1e-12)
    # no moment about the middle of the region
    np.testing.assert_allclose(force[:2] @ (x - 0.5 * (first + last)), 0.0, atol=1e-9 * 5e3)
    assert "nodes of the continuum, steady" in dict(disk_facts(scene))["load house"]


@pytest.mark.parametrize(
    ("place", "line"),
    [
        ({"position": [9.0, 4.0]}, ".position: lies in the continuum, where a force needs a region at least 2 m wide"),
        ({"region": [9.0, 3.0, 10.5, 4.0]}, ".region: has 1.5 m of the continuum's free surface, must have at least 2"),
        ({"region": [9.0, 3.0, 13.0, 4.0]}, ".region: reaches the layer that absorbs; must lie within (-4, -4) to (12"),
        ({"region": [5.0, 3.0, 11.0, 4.0]}, ".region: has particles and free surface of the continuum; give each its"),
        ({"region": [9.0, 1.0, 11.0, 3.0]}, ": no particle is centred in its region [9.0, 1.0, 11.0, 3.0] (m), nor "),
    ],
)
def test_a_force_on_the_continuum_that_cannot_be_is_refused(bar, place: dict, line: str) -> None:
    for wave in ({}, {"wave": "pulse"}):
        with pytest.raises(CaseError) as error:
            _ = loaded(bar, {"name": "house", "force": [0.0, -1.0], **place, **wave}, **SURROUNDED).steady_load
        (found,) = error.value.problems
        assert found.startswith(f"load.house{line}")

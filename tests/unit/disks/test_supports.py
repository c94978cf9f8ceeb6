"""Loads on the particles of a scene: where they act and how hard."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scene_tables import ROCK, grains, lattice, monitors, pulse
from small_cases import around, problems_in, small

from dembound.casefile.disks.load import Load
from dembound.disks.matching import homogenised_beta
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.monitors import monitors_of
from dembound.disks.scene import DiskScene, build
from dembound.disks.supports import forces_of
from dembound.errors import CaseError
from dembound.kinds.disks.facts import disk_facts
from dembound.packings.column import Standing, with_columns
from dembound.packings.tiling import Assembly
from dembound.running import plan, warnings_before

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
    "packing": lattice(8.0, 4.0, 0.5),
    "boundary": around("outside"),
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
        house = {"name": "house", "force": [0.0, -1.0], **place, **wave}
        (found,) = problems_in(lambda house=house: loaded(bar, house, **SURROUNDED).steady_load)
        assert found.startswith(f"load.house{line}")


def scene_of(places: dict[str, tuple[float, float]], changes: dict | None = None) -> DiskScene:
    """Elements of 2 m; absorbing ones begin at x = −4 m, 12 m and y = −4 m."""
    ground = SURROUNDED | {"material": ROCK, "wave": pulse(0.05, 1.0), "run": {"duration": 0.1}}
    return build(small(ground | {"monitor": monitors(**places)}, changes=changes))


def moved(scene: DiskScene, motion: np.ndarray) -> dict[str, np.ndarray]:
    """Motion (3,) of the monitors when the nodes have these displacements (n, 3); velocities are −2 times those."""
    each = motion[scene.probes]
    record = scene.observed(np.hstack([each, -2.0 * each])[None], np.zeros(1))[0]
    np.testing.assert_allclose(record[:, 3:], -2.0 * record[:, :3], rtol=1e-12, atol=1e-14)
    return dict(zip(scene.monitors, record[:, :3], strict=True))


def test_a_monitor_beside_the_body_stands_for_the_disk_of_the_lattice_there() -> None:
    rims = {"rim": (8.0, 2.1), "corner": (0.0, 0.0)}
    scene = scene_of({"in": (0.3, 3.9), "left": (-0.3, 3.9), "low": (9.1, -1.2), **rims, "at": (-3.99, 4.0)})
    places = scene.monitored

    assert list(scene.between) == ["left", "low", "at"]
    assert scene.monitors["in"] < scene.recorded
    for name in scene.between:
        assert scene.monitors[name] >= scene.recorded
    assert places["in"].tolist() == [0.25, 3.75]
    np.testing.assert_allclose(places["left"], [-0.25, 3.75], atol=1e-12)
    np.testing.assert_allclose(places["low"], [9.25, -1.25], atol=1e-12)
    assert places["rim"][0] == 7.75  # its sides belong to the body
    assert places["corner"].tolist() == [0.25, 0.25]
    np.testing.assert_allclose(places["at"], [-3.75, 3.75], atol=1e-12)  # neither above the surface nor in the layer


def test_the_motion_in_a_lattice_is_interpolated() -> None:
    scene = scene_of({"left": (-1.3, 2.2), "low": (3.2, -2.2)})
    x, y = scene.positions.T
    motion = np.stack([x**2 * y**2 - 3.0 * y**3, 2.0 * x**4 - x * y**2, np.zeros_like(x)], axis=1)
    motion[: scene.recorded] = 1e9  # disks do not count
    found = moved(scene, motion)

    # elements of order 4 have both polynomials; half the curl is the rotation of a disk between like neighbours
    for name, (x, y) in scene.monitored.items():
        curl = (8.0 * x**3 - y**2) - (2.0 * x**2 * y - 9.0 * y**2)
        expected = [x**2 * y**2 - 3.0 * y**3, 2.0 * x**4 - x * y**2, 0.5 * curl]
        np.testing.assert_allclose(found[name], expected, rtol=1e-9)


def test_places_in_the_layer_are_refused_with_the_nearest_one_outside() -> None:
    far = {"a": (-5.0, 1.0), "b": (-3.0, 1.0), "c": (12.5, -7.0), "d": (99.0, 4.0)}
    words = "position: lies in the layer that absorbs; the nearest place allowed is"
    places = {"1, a": "(-4, 1) m", "3, c": "(12, -4) m", "4, d": "(12, 4) m"}
    lines = [f"monitor[{name}].{words} {place}" for name, place in places.items()]
    assert problems_in(lambda: scene_of(far)) == lines
    assert list(scene_of({"a": (-4.0, 1.0), "c": (12.0, -4.0)}).between) == ["a", "c"]


def test_below_the_ground_that_waves_enter_there_is_no_monitor() -> None:
    """The continuum there has only the scattered motion, and no column has the rest."""
    waves = {"boundary.bottom": {"type": "outside", "wave_s": "pulse"}}
    (line,) = problems_in(lambda: scene_of({"a": (3.0, -1.0), "b": (3.0, 0.0)}, waves))
    assert line.startswith("monitor[1, a].position: lies below the ground, where incident motion is not known;")


def test_beside_a_column_the_motion_of_the_twin_is_added() -> None:
    places = {"left": (-2.3, 2.2), "right": (11.1, 1.1), "in": (4.0, 2.0)}
    scene = scene_of(places, {"packing": grains(8.0, 4.0, 0.5, 4.0, 0)})
    joint, (seam,) = with_columns(scene.ground.brick, scene.assembly, (Standing(("left", "right")),))
    outside = replace(scene.outside, first=len(joint.radii))
    monitors, between = monitors_of(scene.case, scene.ground, joint, (seam,), outside)

    assert list(monitors) == [*places, *(f"{name}.free_field" for name in places)]
    assert list(between) == ["left", "right"]
    for name, place in between.items():
        twin = monitors[f"{name}.free_field"]
        assert twin < seam.disks.stop
        apart = joint.positions[twin] - joint.positions[0] - (place.place - joint.positions[seam.disks.stop])
        np.testing.assert_allclose(apart[1], 0.0, atol=1e-9)  # at the same height, at the same place of the brick
        np.testing.assert_allclose((apart[0] + 1e-9) % 4.0, 0.0, atol=1e-8)
        assert place.node[-1] == twin
        record = np.random.default_rng(1).normal(size=(5, len(place.node), 6))
        alone = scene.between[name]
        assert np.array_equal(place.node[:-1] - outside.first, alone.node - scene.outside.first)
        np.testing.assert_allclose(place.motion(record), alone.motion(record[:, :-1]) + record[:, -1], rtol=1e-12)


def test_factors_are_those_of_speeds_that_are_not_the_lattices_own(bar) -> None:
    scene = build(bar({"motion.held": []}))

    # equal disks that touch, and the speed of the lattice; a solve with one unknown
    for side in ("left", "right"):
        assert [homogenised_beta(scene, side, motion) for motion in ("p", "s")] == pytest.approx([1.0, 1.0], rel=1e-12)
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": 250.0}
    other = build(bar({"motion.held": [], "material": moduli}))

    # c_s = 500 m/s where the dashpots assume 250
    assert homogenised_beta(other, "right", "s") == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("held", [["y", "rotation"], ["rotation"]])
def test_a_motion_that_nothing_resists_has_no_factor_and_no_speed(bar, held: list[str]) -> None:
    """Contacts without bonds and friction have no shear stiffness."""
    plain = {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 1.0}
    case = bar({"material": plain, "motion.held": held, "boundary.right": {"type": "viscous"}, "monitor": []})
    planned = plan(case)
    scene = planned.scene

    # a row of springs, whose long waves have the lattice's speed; one unknown
    assert scene.ground.wave_speeds(0)[0] == pytest.approx(1000.0, rel=1e-12)
    assert np.isnan(scene.ground.wave_speeds(0)[1])
    assert slowest_speed(scene.ground) == pytest.approx(1000.0, rel=1e-12)
    assert np.isnan(homogenised_beta(scene, "right", "s"))
    assert not any("nan" in line or "inf" in line for line in warnings_before(planned))

"""Monitors in the continuum round a body: which disk they stand for, its motion, its twin, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import small

from dembound.disks.monitors import monitors_of
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.packings.column import with_column

CASE = {
    "packing": {"pattern": "A", "size": [8.0, 4.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
    "outside": {"element": 2.0, "margin": 2},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.05}},
    "run": {"duration": 0.1},
}


def scene_of(places: dict[str, tuple[float, float]], changes: dict | None = None) -> DiskScene:
    """Elements of 2 m; absorbing ones begin at x = −4 m, 12 m and y = −4 m."""
    monitor = [{"name": name, "position": list(place)} for name, place in places.items()]
    return build(small(CASE, changes={"monitor": monitor} | (changes or {})))


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
    with pytest.raises(CaseError) as error:
        scene_of({"a": (-5.0, 1.0), "b": (-3.0, 1.0), "c": (12.5, -7.0), "d": (99.0, 4.0)})
    words = "position: lies in the layer that absorbs; the nearest place allowed is"
    places = {"1, a": "(-4, 1) m", "3, c": "(12, -4) m", "4, d": "(12, 4) m"}
    assert error.value.problems == [f"monitor[{name}].{words} {place}" for name, place in places.items()]
    assert list(scene_of({"a": (-4.0, 1.0), "c": (12.0, -4.0)}).between) == ["a", "c"]


def test_below_the_ground_that_waves_enter_there_is_no_monitor() -> None:
    """The continuum there has only the scattered motion, and no column has the rest."""
    waves = {"boundary.bottom": {"type": "outside", "wave_s": "pulse"}}
    with pytest.raises(CaseError) as error:
        scene_of({"a": (3.0, -1.0), "b": (3.0, 0.0)}, waves)
    (line,) = error.value.problems
    assert line.startswith("monitor[1, a].position: lies below the ground, where incident motion is not known;")


GRAINS = {"packing": {"pattern": "B", "size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}}


def test_beside_a_column_the_motion_of_the_twin_is_added() -> None:
    places = {"left": (-2.3, 2.2), "right": (11.1, 1.1), "in": (4.0, 2.0)}
    scene = scene_of(places, GRAINS)
    joint, seam = with_column(scene.ground.brick, scene.assembly, ("left", "right"))
    outside = replace(scene.outside, first=len(joint.radii))
    monitors, between = monitors_of(scene.case, scene.ground, joint, seam, outside)

    assert list(monitors) == [*places, *(f"{name}.free_field" for name in places)]
    assert list(between) == ["left", "right"]
    for name, place in between.items():
        twin = monitors[f"{name}.free_field"]
        assert twin < seam.count
        apart = joint.positions[twin] - joint.positions[0] - (place.place - joint.positions[seam.count])
        np.testing.assert_allclose(apart[1], 0.0, atol=1e-9)  # at the same height, at the same place of the brick
        np.testing.assert_allclose((apart[0] + 1e-9) % 4.0, 0.0, atol=1e-8)
        assert place.node[-1] == twin
        record = np.random.default_rng(1).normal(size=(5, len(place.node), 6))
        alone = scene.between[name]
        assert np.array_equal(place.node[:-1] - outside.first, alone.node - scene.outside.first)
        np.testing.assert_allclose(place.motion(record), alone.motion(record[:, :-1]) + record[:, -1], rtol=1e-12)

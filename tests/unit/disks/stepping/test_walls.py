"""Walls as a part: where they are in each step, the segments near a place, and contacts handed to another stage."""

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import build
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.stepping.walls import Lines, path_of
from dembound.kernels.wall_contacts import OVERLAP, PUSH
from dembound.kernels.wall_contacts import WALL as NUMBER

LOOSE = {
    "packing": {"pattern": "A", "size": [2.0, 1.0], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5, "kratio": 2.0},
    "wall": [
        {"name": "floor", "points": [[-1.0, 0.01], [3.0, 0.01]], "wave_y": "push", "until": 0.035},
        {"name": "back", "points": [[-0.5, 0.0], [-0.5, 1.0], [-1.0, 1.5]], "velocity": [2.0, 1.0]},
    ],
    "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 0.1}},
    "run": {"duration": 0.1},
}


def test_walls_move_by_their_velocities_in_the_middle_of_steps() -> None:
    case = small(LOOSE)
    path = path_of(build(case), 10, 0.01)
    assert path.shape == (12, 2, 2)
    assert (path[-1] == path[-2]).all()
    np.testing.assert_allclose(path[:11, 1], 0.01 * np.arange(11)[:, None] * (2.0, 1.0))
    middles = (np.arange(10) + 0.5) * 0.01
    moved = np.where(middles <= 0.035, case.wave["push"].velocity(middles), 0.0)
    np.testing.assert_allclose(path[1:11, 0, 1], 0.01 * np.cumsum(moved))
    assert not path[:, 0, 0].any()


def test_a_wall_moves_with_a_driven_bottom_or_an_incident_wave_and_its_reflection() -> None:
    wall = {"name": "rock", "points": [[30.0, 0.0], [40.0, 20.0]], "moves": "incident"}
    words = {"packing": {"pattern": "A", "size": [4.0, 4.0], "radius": 0.25}, "wall": [wall]}
    words["material"] = {"density": 2500.0, "p_wave_speed": 1e3, "law": "linearpbond", "fric": 0.5}
    driven = {"type": "velocity", "wave_s": "push", "hold": ["normal", "shear"]}
    path = path_of(build(small(LOOSE | words | {"boundary": {"bottom": driven}})), 10, 0.01)
    push = small(LOOSE).wave["push"].velocity((np.arange(10) + 0.5) * 0.01)
    np.testing.assert_allclose(path[1:11, 0, 0], 0.01 * np.cumsum(push))
    assert not path[..., 1].any()

    beyond = {side: {"type": "outside"} for side in ("left", "right", "bottom")}
    words |= {"boundary": beyond, "incident": {"type": "p", "angle": 0.0, "wave": "push"}}
    for at, height in (([0.0, 2.0], 2.0), ([0.0, 3.0], 3.0), (None, 4.0)):  # the middle is above the surface
        scene = build(small(LOOSE | words | {"wall": [wall | ({"at": at} if at else {})]}))
        times = (np.arange(100) + 0.5) * 1e-3
        push = [scene.case.wave["push"].velocity(times - way / 1e3) for way in (height, 8.0 - height)]
        path = path_of(scene, 100, 1e-3)
        # the mass of disks ends half a disk of the surface off the box at most: 0.25 ms of a period of 100 ms
        np.testing.assert_allclose(path[1:101, 0, 1], 1e-3 * np.cumsum(sum(push)), atol=2e-2 * path.max())


def test_ranges_hold_all_segments_that_reach_into_them() -> None:
    rng = np.random.default_rng(1)
    ends = rng.uniform((-30.0, 0.0) * 2, (30.0, 4.0) * 2, (200, 4))
    shift = rng.uniform(-2.0, 2.0, (200, 2))
    axis, low, width, start, member = Lines(ends, np.zeros(200, np.int64)).ranges(shift, 0.7)
    assert axis == 0
    spans = ends[:, ::2] + shift[:, :1]
    for place in rng.uniform(spans.min() - 0.5, spans.max() + 0.5, 300):
        near = np.flatnonzero((spans.min(axis=1) - 0.7 <= place) & (place <= spans.max(axis=1) + 0.7))
        b = int(np.floor((place - low) / width))
        assert set(near) <= set(member[start[b] : start[b + 1]])


def test_contacts_at_rest_go_on_and_are_restored() -> None:
    """Forces follow from them at the same places, by stiffness of the disk alone, which is twice that of two."""
    scene = build(small(LOOSE))
    system = DiskSystem(scene, 1e-4)
    nothing = np.zeros((3, scene.count))
    system.walls.push(nothing)
    touching = system.walls.touching
    assert touching.disk.tolist() == np.flatnonzero(scene.positions[:, 1] < 0.3).tolist()
    assert touching.kept[:, 0, OVERLAP] == pytest.approx(0.01)
    assert not touching.kept[:, 1:, PUSH].any()
    assert not touching.kept[:, 0, NUMBER].any()

    force = np.zeros((3, scene.count))
    system.walls.push(nothing)
    system.walls.add_forces(force)
    np.testing.assert_allclose(force[1], np.where(scene.positions[:, 1] < 0.3, 2.0 * 1e8 * 0.01, 0.0))
    assert system.walls.stored(nothing)[0] == pytest.approx(4 * 0.5 * 2.0 * 1e8 * 0.01**2)

    other = DiskSystem(scene, 1e-4)
    other.walls.restore(system.walls.saved_arrays())
    for name, values in system.walls.saved_arrays().items():
        np.testing.assert_array_equal(other.walls.saved_arrays()[name], values, err_msg=name)
    assert other.walls.stored(nothing) == system.walls.stored(nothing)


def test_steady_loads_are_there_again_after_a_step() -> None:
    scene = build(small(LOOSE))
    system = DiskSystem(scene, 1e-4)
    first, *_, last = system.laws()
    assert first is system.walls.law()
    assert last.slot is first.slot
    assert last.load is first.load

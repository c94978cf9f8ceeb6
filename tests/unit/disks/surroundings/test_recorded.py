"""Records of a continuum have the total motion of its nodes beside the scattered one that it is computed with."""

import h5py
import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.disks.scene import build
from dembound.motion.simulation import Simulation
from dembound.plot.field import read_field
from dembound.results.recorder import Recorder

WAVES = {
    "boundary.bottom": {"type": "outside", "wave_s": "up"},
    "wave.up": {"type": "cosine", "amplitude": 1.0, "period": 0.1},
    "output.peaks": True,
}


@pytest.fixture(scope="module")
def waved(tmp_path_factory):
    """A record of disks in a continuum beside a column, all of which is in random motion, and its folder."""
    scene = build(small(SURROUNDED, "waved", WAVES))
    simulation, rng = Simulation(scene, 1e-4), np.random.default_rng(3)
    folder = tmp_path_factory.mktemp("waved")
    with Recorder(folder / "run.h5", simulation, 2e-4) as recorder:
        simulation.state.displacement = 1e-3 * rng.normal(size=(3, scene.count)) * scene.moves
        simulation.state.velocity = rng.normal(size=(3, scene.count)) * scene.moves
        recorder.snapshot()
    return scene, simulation.state, folder


@pytest.mark.parametrize("name", ["displacement", "velocity"])
def test_beside_a_column_the_total_motion_is_recorded_too(waved, name) -> None:
    scene, state, folder = waved
    values = getattr(state, name)
    own = values[:, scene.beside.nodes].T
    row = scene.positions[: scene.seam.count, 1]
    heights = np.unique(row)
    means = [[values[axis, : scene.seam.count][row == height].mean() for height in heights] for axis in (0, 1)]
    up = scene.positions[scene.beside.nodes, 1]
    known = (up >= -1e-9)[:, None]  # the column reaches down to y = 0
    ground = np.column_stack([np.interp(up, heights, means[axis]) for axis in (0, 1)])
    with h5py.File(folder / "run.h5") as file:
        beyond = file["snapshots/0000/continuum"]
        np.testing.assert_array_equal(beyond[f"scattered_{name}"][:], own)
        np.testing.assert_allclose(beyond[name][:, :2], own[:, :2] + ground * known, atol=1e-12)
    assert np.abs(ground).max() > 0.1 * np.abs(own).max()


def test_stresses_of_the_scattered_motion_are_not_drawn_beside_total_ones(waved, tmp_path) -> None:
    _, _, folder = waved
    path = tmp_path / "run.h5"
    path.write_bytes((folder / "run.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        for snapshot in file["snapshots"].values():
            snapshot["stress"] = np.ones((len(file["particles/radius"]), 3))
    with h5py.File(path) as file:
        assert read_field(file, "stress_xx", None, 0, 1).beyond is None
        assert read_field(file, "peak", None, None, 1).beyond is None
        assert read_field(file, "velocity", "x", 0, 1).beyond is not None

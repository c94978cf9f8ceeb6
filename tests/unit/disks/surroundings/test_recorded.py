"""Records of a continuum have the total motion of its nodes beside the scattered one that it is computed with."""

import h5py
import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.disks.scene import build
from dembound.motion.simulation import Simulation
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


def test_beside_a_column_the_total_motion_is_recorded_too(waved) -> None:
    (scene, state, folder), name = waved, "velocity"
    values = state.velocity
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

"""The motion of the ground at heights beside a column of disks, and the total one of a continuum in the record."""

import h5py
import meshio
import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.disks.beyond.ground_motion import GroundMotion
from dembound.disks.kind import Disks
from dembound.disks.scene import build
from dembound.motion.simulation import Simulation
from dembound.plot.field import read_field
from dembound.results.recorder import Recorder
from dembound.results.vtk import write_paraview

WAVES = {
    "boundary.bottom": {"type": "outside", "wave_s": "up"},
    "wave.up": {"type": "cosine", "amplitude": 1.0, "period": 0.1},
    "output.peaks": True,
}


def test_rows_of_a_lattice_are_joined_by_straight_lines() -> None:
    up = np.repeat([0.5, 1.5, 2.5], 2)
    values = np.column_stack([np.repeat([1.0, 3.0, 2.0], 2), np.repeat([-4.0, 0.0, 8.0], 2), np.ones(6)])
    found = GroundMotion(up, np.ones(6), 1.0, np.array([0.0, 0.5, 1.0, 2.25, 3.0])).at_heights(values)
    np.testing.assert_allclose(found[:, 0], [1.0, 1.0, 2.0, 2.25, 2.0], rtol=1e-14)
    np.testing.assert_allclose(found[:, 1], [-4.0, -4.0, -2.0, 6.0, 8.0], rtol=1e-14)
    np.testing.assert_array_equal(found[:, 2], 0.0)


def test_disks_of_a_band_count_by_their_mass_at_its_centre_of_mass() -> None:
    """So that a uniform strain is exact between the first and the last band, whatever the disks."""
    rng = np.random.default_rng(4)
    up, mass = rng.uniform(0.0, 8.0, 60), rng.uniform(1.0, 2.0, 60)
    heights = np.linspace(1.0, 7.0, 23)
    values = np.column_stack([3.0 * up - 1.0, 2.0 - 5.0 * up, up])
    found = GroundMotion(up, mass, 1.0, heights).at_heights(values)
    np.testing.assert_allclose(found[:, :2], np.column_stack([3.0 * heights - 1.0, 2.0 - 5.0 * heights]), atol=1e-12)


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
    own = values[:, scene.nodes_beside].T
    row = scene.positions[: scene.seam.count, 1]
    heights = np.unique(row)
    means = [[values[axis, : scene.seam.count][row == height].mean() for height in heights] for axis in (0, 1)]
    up = scene.positions[scene.nodes_beside, 1]
    known = (up >= -1e-9)[:, None]  # the column reaches down to y = 0
    ground = np.column_stack([np.interp(up, heights, means[axis]) for axis in (0, 1)])
    with h5py.File(folder / "run.h5") as file:
        beyond = file["snapshots/0000/continuum"]
        np.testing.assert_array_equal(beyond[f"scattered_{name}"][:], own)
        np.testing.assert_allclose(beyond[name][:, :2], own[:, :2] + ground * known, atol=1e-12)
    assert np.abs(ground).max() > 0.1 * np.abs(own).max()


def test_paraview_is_given_both(waved) -> None:
    _, _, folder = waved
    write_paraview(folder / "run.h5", folder / "paraview", Disks())
    data = meshio.read(folder / "paraview" / "continuum_0000.vtu").point_data
    with h5py.File(folder / "run.h5") as file:
        fields = {name: values[:] for name, values in file["snapshots/0000/continuum"].items()}
    shown = {"linVelVec": "velocity", "scatteredVelocity": "scattered_velocity"}
    shown |= {"displacement": "displacement", "scattered": "scattered_displacement"}
    for name, column in shown.items():
        np.testing.assert_array_equal(data[name][:, :2], fields[column][:, :2].astype(np.float32), err_msg=name)


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

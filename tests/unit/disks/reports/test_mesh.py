"""What ParaView is given of disks equals the record."""

import h5py
import meshio
import numpy as np
import pytest
import pyvista

from dembound.disks.kind import Disks
from dembound.results.vtk import write_paraview


@pytest.fixture(scope="module")
def exported(small_run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("vtu") / "paraview"
    write_paraview(small_run, folder, Disks())
    return folder


def expected(file: h5py.File, number: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Points and point data of a snapshot, written out column by column, and rounded to single precision."""
    particles, snapshot = file["particles"], file["snapshots"][number]
    displacement, velocity = snapshot["displacement"][:], snapshot["velocity"][:]
    points, moved, linear, angular = (np.zeros((len(velocity), 3)) for _ in range(4))
    for axis in range(2):
        points[:, axis] = particles["position"][:, axis] + displacement[:, axis]
        moved[:, axis] = displacement[:, axis]
        linear[:, axis] = velocity[:, axis]
    angular[:, 2] = velocity[:, 2]
    data = {
        "radii": particles["radius"][:],
        "id": np.arange(len(velocity)),
        "linVelVec": linear,
        "angVelVec": angular,
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": moved,
        "rotation": displacement[:, 2],
        "brick_particle": particles["brick_particle"][:],
        "column": np.zeros(len(velocity)),
        "nbCracks": np.zeros(len(velocity)),
        "damage": np.zeros(len(velocity)),
    }
    return points, {name: values.astype(np.float32) for name, values in data.items()}


def test_positions_are_in_double_and_fields_in_single_precision(exported):
    mesh = meshio.read(exported / "particles_0001.vtu")
    kinds = {name: values.dtype for name, values in mesh.point_data.items()}
    whole = {"id", "brick_particle", "nbCracks"}
    assert mesh.points.dtype == np.float64
    assert kinds.pop("column") == np.uint8
    assert kinds == {name: np.int32 if name in whole else np.float32 for name in kinds}


@pytest.mark.parametrize("number", ["0000", "0001"])
def test_meshio_reads_back_what_the_record_holds(small_run, exported, number):
    mesh = meshio.read(exported / f"particles_{number}.vtu")
    with h5py.File(small_run) as file:
        points, data = expected(file, number)
    assert all(np.abs(data[name]).max() > 0.0 for name in ("linVelVec", "angVelVec", "displacement", "rotation"))
    np.testing.assert_array_equal(mesh.points, points)
    assert mesh.point_data.keys() == data.keys()
    for name, values in data.items():
        np.testing.assert_array_equal(mesh.point_data[name], values, err_msg=name)


def test_vtk_reads_one_vertex_per_disk(small_run, exported):
    mesh = pyvista.read(exported / "particles_0001.vtu")
    with h5py.File(small_run) as file:
        points, data = expected(file, "0001")
    assert mesh.n_cells == len(points)
    assert set(mesh.celltypes) == {pyvista.CellType.VERTEX}
    np.testing.assert_array_equal(mesh.points, points)
    for name, values in data.items():
        np.testing.assert_array_equal(mesh.point_data[name], values, err_msg=name)


def test_stress_is_a_symmetric_tensor_and_peaks_are_in_every_file(rich_run, tmp_path):
    write_paraview(rich_run, tmp_path, Disks())
    with h5py.File(rich_run) as file:
        for number, snapshot in file["snapshots"].items():
            mesh = pyvista.read(tmp_path / f"particles_{number}.vtu")
            xx, yy, xy = snapshot["stress"][:].T
            zero = np.zeros_like(xx)
            # VTK's order: xx, yy, zz, xy, yz, xz
            tensors = np.array([xx, yy, zero, xy, zero, zero], dtype=np.float32)
            np.testing.assert_array_equal(mesh.point_data["stress"].T, tensors)
            peaks = file["particles/peak_velocity"][:].astype(np.float32)
            np.testing.assert_array_equal(mesh.point_data["peakVelocity"], peaks)


def test_circle_glyphs_of_factor_two_have_the_radii(exported):
    # as the module tells users to set ParaView's glyph filter, whose 2D circle has the diameter 1
    mesh = pyvista.read(exported / "particles_0000.vtu")
    circle = pyvista.Circle(radius=0.5, resolution=4)
    disks = mesh.glyph(geom=circle, scale="radii", factor=2.0, orient=False)
    corners = disks.points.reshape(mesh.n_points, -1, 3) - mesh.points[:, None, :]
    # VTK keeps glyph points in single precision: 6e-8 of coordinates up to 10 m
    np.testing.assert_allclose(np.linalg.norm(corners, axis=2), 0.25, atol=2e-6)


def test_cracks_and_damage_are_counted_up_to_each_snapshot(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    with h5py.File(cracked_run) as file:
        bonds, cracks = file["particles/bonds"][:], {name: values[:] for name, values in file["cracks"].items()}
        for number, snapshot in file["snapshots"].items():
            data = meshio.read(tmp_path / f"particles_{number}.vtu").point_data
            counted = np.zeros(len(bonds), dtype=int)
            for time, pair in zip(cracks["time"], cracks["particles"], strict=True):
                counted[pair] += time <= snapshot.attrs["time"]
            np.testing.assert_array_equal(data["nbCracks"], counted)
            np.testing.assert_array_equal(data["damage"], (counted / bonds).astype(np.float32))
            np.testing.assert_array_equal(data["coordNumber"], snapshot["coordination"][:])
        broken = [np.count_nonzero(cracks["time"] <= each.attrs["time"]) for each in file["snapshots"].values()]
    assert 0 < broken[0] < broken[1] == len(cracks["time"])


def test_contacts_are_lines_between_the_centres_of_their_disks(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    with h5py.File(cracked_run) as file:
        counts = [len(snapshot["contacts/bonded"]) for snapshot in file["snapshots"].values()]
        for number, snapshot in file["snapshots"].items():
            mesh = pyvista.read(tmp_path / f"contacts_{number}.vtu")
            disks = pyvista.read(tmp_path / f"particles_{number}.vtu")
            contacts = {name: values[:] for name, values in snapshot["contacts"].items()}
            ends = mesh.points.reshape(-1, 2, 3)
            first, second = contacts["particles"].T
            assert set(mesh.celltypes) == {pyvista.CellType.LINE}
            np.testing.assert_array_equal(mesh.cell_connectivity, np.arange(2 * len(first)))
            # places of up to 10 m
            np.testing.assert_array_equal(ends[:, 0], disks.points[first])
            np.testing.assert_allclose(ends[:, 1], disks.points[second], atol=1e-12)
            np.testing.assert_array_equal(mesh.cell_data["particles"], contacts["particles"])
            for name, column in (("normalForce", "normal_force"), ("shearForce", "shear_force")):
                np.testing.assert_array_equal(mesh.cell_data[name], contacts[column].astype(np.float32))
            np.testing.assert_array_equal(mesh.cell_data["bonded"], contacts["bonded"])
            assert contacts["bonded"].any()
    assert counts[1] < counts[0]  # where bonds have broken


def test_disks_of_a_column_are_marked(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    marked = np.arange(100) < 25
    with h5py.File(run, "r+") as file:
        assert not file["particles/column"][:].any()
        file["particles/column"][:] = marked
    write_paraview(run, tmp_path / "paraview", Disks())
    column = pyvista.read(tmp_path / "paraview" / "particles_0001.vtu").point_data["column"]
    np.testing.assert_array_equal(column, marked)

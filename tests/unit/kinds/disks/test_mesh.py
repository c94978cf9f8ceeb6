"""Meshes of disks and of a continuum for ParaView equal the record."""

import h5py
import meshio
import numpy as np
import pytest
import pyvista

from dembound.continuum.mesh import Around, Mesh
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.mesh import continuum_mesh
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
    flat, moved, linear = (
        np.pad(each[:, :2], ((0, 0), (0, 1))) for each in (particles["position"][:], displacement, velocity)
    )
    data = {
        "radii": particles["radius"][:],
        "id": np.arange(len(velocity)),
        "linVelVec": linear,
        "angVelVec": velocity * [0.0, 0.0, 1.0],
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": moved,
        "rotation": displacement[:, 2],
        "brick_particle": particles["brick_particle"][:],
        "column": np.zeros(len(velocity)),
        "nbCracks": np.zeros(len(velocity)),
        "damage": np.zeros(len(velocity)),
    }
    return flat + moved, {name: values.astype(np.float32) for name, values in data.items()}


def test_meshio_and_vtk_read_back_what_the_record_holds(small_run, exported):
    """Places in double and fields in single precision, one vertex per disk."""
    mesh, of_vtk = meshio.read(exported / "particles_0001.vtu"), pyvista.read(exported / "particles_0001.vtu")
    with h5py.File(small_run) as file:
        points, data = expected(file, "0001")
    assert all(np.abs(data[name]).max() > 0.0 for name in ("linVelVec", "angVelVec", "displacement", "rotation"))
    assert set(of_vtk.celltypes) == {pyvista.CellType.VERTEX}
    assert mesh.point_data.keys() == data.keys()
    for name, values in data.items():
        for found in (mesh, of_vtk):
            np.testing.assert_array_equal(found.points, points)
            np.testing.assert_array_equal(found.point_data[name], values, err_msg=name)


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
        for number, snapshot in file["snapshots"].items():
            mesh = pyvista.read(tmp_path / f"contacts_{number}.vtu")
            disks = pyvista.read(tmp_path / f"particles_{number}.vtu")
            contacts = {name: values[:] for name, values in snapshot["contacts"].items()}
            ends = mesh.points.reshape(-1, 2, 3)
            first, second = contacts["particles"].T
            assert set(mesh.celltypes) == {pyvista.CellType.LINE}
            # places of up to 10 m
            np.testing.assert_array_equal(ends[:, 0], disks.points[first])
            np.testing.assert_allclose(ends[:, 1], disks.points[second], atol=1e-12)
            np.testing.assert_array_equal(mesh.cell_data["particles"], contacts["particles"])
            for name, column in (("normalForce", "normal_force"), ("shearForce", "shear_force")):
                np.testing.assert_array_equal(mesh.cell_data[name], contacts[column].astype(np.float32))
            np.testing.assert_array_equal(mesh.cell_data["bonded"], contacts["bonded"])


@pytest.fixture(scope="module")
def exported_continuum(surrounded_run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("vtu") / "paraview"
    write_paraview(surrounded_run, folder, Disks())
    return folder


def test_vtk_reads_one_quadrilateral_per_cell(surrounded_run, exported_continuum) -> None:
    number = "0001"
    mesh = pyvista.read(exported_continuum / f"continuum_{number}.vtu")
    with h5py.File(surrounded_run) as file:
        columns = {name: values[:] for name, values in file["continuum"].items()}
        fields = {name: values[:] for name, values in file[f"snapshots/{number}/continuum"].items()}
    moved, velocity, stress = fields["displacement"], fields["velocity"], fields["stress"]
    points = np.zeros((len(moved), 3))
    points[:, :2] = columns["position"] + moved[:, :2]
    linear, shift, tensor = np.zeros_like(points), np.zeros_like(points), np.zeros((len(points), 6))
    linear[:, :2], shift[:, :2] = velocity[:, :2], moved[:, :2]
    tensor[:, 0], tensor[:, 1], tensor[:, 3] = stress.T  # VTK's order: xx, yy, zz, xy, yz, xz
    data = {
        "linVelVec": linear,
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": shift,
        "stress": tensor,
        "absorbs": columns["absorbs"],
        "peakVelocity": columns["peak_velocity"],
    }
    assert set(mesh.celltypes) == {pyvista.CellType.QUAD}
    np.testing.assert_array_equal(mesh.cell_connectivity.reshape(-1, 4), columns["cell"])
    np.testing.assert_array_equal(mesh.points, points)
    assert mesh.point_data.keys() == list(data)
    for name, values in data.items():
        np.testing.assert_array_equal(mesh.point_data[name], values.astype(np.float32), err_msg=name)


@pytest.mark.parametrize(("axis", "columns"), [(0, 1), (1, 3)])
def test_the_last_cells_of_a_periodic_continuum_reach_its_first_nodes(axis: int, columns: int) -> None:
    """The first nodes are repeated a period on, with all their data, so that no gap is left."""
    along = (columns, 4) if axis == 0 else (4, columns)
    layer = Around(bottom=2) if axis == 0 else Around(left=2)
    mesh = Mesh.uniform(
        order=3, element=(2.0, 1.5), cells=along, origin=(1.0, -2.0), layer=layer, periodic=(axis == 0, axis == 1)
    )
    data = {"position": mesh.positions, "cell": mesh.node_cells, "element": mesh.rectangles, "node": mesh.nodes}
    data["absorbs"] = np.any(mesh.depth > 0.0, axis=1)
    rng = np.random.default_rng(0)
    moved = {name: rng.normal(size=(mesh.count, 3)) for name in ("displacement", "velocity", "stress")}
    moved["displacement"] *= 1e-9
    made = continuum_mesh(*({f"continuum/{name}": each for name, each in of.items()} for of in (data, moved)))

    first = np.flatnonzero(mesh.positions[:, axis] < mesh.origin[axis] + 1e-9)
    repeated = made.points[mesh.count :, :2]
    shift = np.zeros(2)
    shift[axis] = mesh.size[axis]
    np.testing.assert_allclose(repeated, mesh.positions[first] + shift, rtol=0.0, atol=1e-8)
    for name, values in made.point_data.items():
        np.testing.assert_array_equal(values[mesh.count :], values[first], err_msg=name)

"""Snapshots of a run are listed with their times; VTK reads the same from one file as from the file of each."""

from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
import pyvista
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from dembound.kinds.bar.kind import Bars
from dembound.kinds.disks.kind import Disks
from dembound.results.vtk import write_paraview


@pytest.fixture(scope="module")
def exported(small_run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("vtu") / "paraview"
    write_paraview(small_run, folder, Disks())
    return folder


def test_the_index_lists_files_and_times(small_run, other_run, exported, tmp_path):
    entries = ElementTree.parse(exported / "particles.pvd").getroot().findall("Collection/DataSet")
    with h5py.File(small_run) as file:
        times = [float(snapshot.attrs["time"]) for snapshot in file["snapshots"].values()]
    assert [entry.get("file") for entry in entries] == ["particles_0000.vtu", "particles_0001.vtu"]
    assert [float(entry.get("timestep")) for entry in entries] == times
    assert pyvista.get_reader(exported / "particles.pvd").time_values == times
    write_paraview(other_run, tmp_path / "paraview", Disks())  # has no snapshots
    assert list(tmp_path.iterdir()) == []


def test_each_crack_is_a_vertex_where_it_was(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    mesh = pyvista.read(tmp_path / "cracks.vtu")
    with h5py.File(cracked_run) as file:
        cracks = {name: values[:] for name, values in file["cracks"].items()}
    assert set(mesh.celltypes) == {pyvista.CellType.VERTEX}
    np.testing.assert_array_equal(mesh.points[:, :2], cracks["position"])
    np.testing.assert_array_equal(mesh.point_data["time"], cracks["time"])
    np.testing.assert_array_equal(mesh.point_data["mode"], np.where(cracks["shear"], 1, 0))
    np.testing.assert_array_equal(mesh.point_data["particles"], cracks["particles"])


def steps_of(path):
    """The times (k,) that VTK lists, and the mesh it reads at each, from one reader that is moved to and fro."""
    reader = pyvista.get_reader(path)
    algorithm = reader.reader  # VTK's own
    algorithm.UpdateInformation()
    times = list(algorithm.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()))
    meshes = {}
    for number in [*range(len(times)), *reversed(range(len(times)))]:
        algorithm.UpdateTimeStep(times[number])
        mesh = pyvista.wrap(algorithm.GetOutputDataObject(0)).copy(deep=True)
        if number in meshes:
            assert_same(mesh, meshes[number])
        meshes[number] = mesh
    return times, [meshes[number] for number in range(len(times))]


def assert_same(mesh, expected):
    """Points, cells and all arrays, with their types and widths."""
    assert isinstance(mesh, pyvista.UnstructuredGrid)
    for name in ("points", "celltypes", "cells"):
        np.testing.assert_array_equal(getattr(mesh, name), getattr(expected, name), err_msg=name)
    assert mesh.points.dtype == expected.points.dtype == np.float64
    for arrays, others in ((mesh.point_data, expected.point_data), (mesh.cell_data, expected.cell_data)):
        assert set(arrays.keys()) == set(others.keys())
        for name in others:
            assert (arrays[name].dtype, arrays[name].shape) == (others[name].dtype, others[name].shape)
            np.testing.assert_array_equal(arrays[name], others[name], err_msg=name)


@pytest.mark.parametrize(
    ("run", "kind", "name"),
    [("rich_run", Disks(), "particles"), ("cracked_run", Disks(), "contacts"), ("spalled_run", Bars(), "bar")],
)
def test_all_times_and_arrays_are_those_of_the_single_files(request, tmp_path, run, kind, name):
    record = request.getfixturevalue(run)
    write_paraview(record, tmp_path, kind, "both")
    index = pyvista.get_reader(tmp_path / f"{name}.pvd")
    times, meshes = steps_of(tmp_path / f"{name}.vtkhdf")
    with h5py.File(record) as file:
        assert times == index.time_values == [group.attrs["time"] for group in file["snapshots"].values()]
    assert len(times) > 1
    for number, mesh in enumerate(meshes):
        assert_same(mesh, pyvista.read(tmp_path / f"{name}_{number:04d}.vtu"))
    assert any(not np.array_equal(mesh.points, meshes[0].points) for mesh in meshes)

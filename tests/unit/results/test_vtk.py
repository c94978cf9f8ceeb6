"""Snapshots of a run are listed with their times, beside its cracks."""

import ast
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
import pyvista

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
    names = sorted(path.name for path in exported.iterdir())
    assert names == ["particles.pvd", "particles_0000.vtu", "particles_0001.vtu", "view.py"]
    ast.parse((exported / "view.py").read_text())
    write_paraview(other_run, tmp_path / "paraview", Disks())  # has no snapshots
    assert list(tmp_path.iterdir()) == []


def test_more_than_ten_thousand_files_are_in_the_order_of_time_by_name_too(small_run, long_run, tmp_path):
    write_paraview(small_run, tmp_path / "few", Disks())
    write_paraview(long_run, tmp_path / "many", Disks(), "both")
    entries = ElementTree.parse(tmp_path / "many" / "particles.pvd").getroot().findall("Collection/DataSet")
    assert [entry.get("file") for entry in entries] == ["particles_09999.vtu", "particles_10000.vtu"]
    times = [float(entry.get("timestep")) for entry in entries]
    with h5py.File(tmp_path / "many" / "particles.vtkhdf") as file:
        assert times == sorted(times) == file["VTKHDF/Steps/Values"][:].tolist()
    last = (tmp_path / "many" / "particles_10000.vtu").read_bytes()
    assert last == (tmp_path / "few" / "particles_0001.vtu").read_bytes()


def test_each_crack_is_a_vertex_where_it_was(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    mesh = pyvista.read(tmp_path / "cracks.vtu")
    with h5py.File(cracked_run) as file:
        cracks = {name: values[:] for name, values in file["cracks"].items()}
    assert set(mesh.celltypes) == {pyvista.CellType.VERTEX}
    np.testing.assert_array_equal(mesh.points[:, :2], cracks["position"])
    np.testing.assert_array_equal(mesh.points[:, 2], 0.0)
    np.testing.assert_array_equal(mesh.point_data["time"], cracks["time"])
    np.testing.assert_array_equal(mesh.point_data["mode"], np.where(cracks["shear"], 1, 0))
    np.testing.assert_array_equal(mesh.point_data["particles"], cracks["particles"])
    assert set(mesh.point_data["mode"]) == {0, 1}

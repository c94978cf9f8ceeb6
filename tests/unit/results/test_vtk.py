"""Snapshots of a run are listed with their times, beside its cracks."""

import ast
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
import pyvista

from dembound.disks.kind import Disks
from dembound.results.vtk import write_vtu


@pytest.fixture(scope="module")
def exported(small_run, tmp_path_factory):
    return write_vtu(small_run, tmp_path_factory.mktemp("vtu") / "paraview", Disks())


def test_the_index_lists_files_and_times(small_run, exported):
    entries = ElementTree.parse(exported).getroot().findall("Collection/DataSet")
    with h5py.File(small_run) as file:
        times = [float(snapshot.attrs["time"]) for snapshot in file["snapshots"].values()]
    assert [entry.get("file") for entry in entries] == ["particles_0000.vtu", "particles_0001.vtu"]
    assert [float(entry.get("timestep")) for entry in entries] == times
    assert pyvista.get_reader(exported).time_values == times


def test_more_than_ten_thousand_files_are_in_the_order_of_time_by_name_too(small_run, long_run, tmp_path):
    write_vtu(small_run, tmp_path / "few", Disks())
    index = write_vtu(long_run, tmp_path / "many", Disks())
    entries = ElementTree.parse(index).getroot().findall("Collection/DataSet")
    assert [entry.get("file") for entry in entries] == ["particles_09999.vtu", "particles_10000.vtu"]
    times = [float(entry.get("timestep")) for entry in entries]
    with h5py.File(tmp_path / "many" / "particles.vtkhdf") as file:
        assert times == sorted(times) == file["VTKHDF/Steps/Values"][:].tolist()
    last = (tmp_path / "many" / "particles_10000.vtu").read_bytes()
    assert last == (tmp_path / "few" / "particles_0001.vtu").read_bytes()


def test_the_folder_holds_the_view_script_and_no_leftovers(exported):
    names = sorted(path.name for path in exported.parent.iterdir())
    assert names == ["particles.pvd", "particles.vtkhdf", "particles_0000.vtu", "particles_0001.vtu", "view.py"]
    ast.parse((exported.parent / "view.py").read_text())


def test_each_crack_is_a_vertex_where_it_was(cracked_run, tmp_path):
    write_vtu(cracked_run, tmp_path, Disks())
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


def test_a_run_without_snapshots_writes_nothing(other_run, tmp_path):
    assert write_vtu(other_run, tmp_path / "paraview", Disks()) is None
    assert list(tmp_path.iterdir()) == []

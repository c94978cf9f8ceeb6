"""Meshes of a bar for ParaView equal the record."""

import h5py
import numpy as np
import pytest
import pyvista

from dembound.kinds.bar.kind import Bars
from dembound.results.vtk import write_paraview


@pytest.fixture(scope="module")
def exported(spalled_run, tmp_path_factory):
    """The record of that bar with peaks, and the folder it has been written to."""
    folder = tmp_path_factory.mktemp("vtu")
    run = folder / "run.h5"
    run.write_bytes(spalled_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["particles/peak_velocity"] = np.linspace(0.0, 3.0, 41)
    write_paraview(run, folder / "paraview", Bars())
    return folder / "paraview"


@pytest.mark.parametrize("number", ["0003", "0011"])
def test_nodes_stand_where_they_have_moved_with_what_the_record_holds(spalled_run, exported, number):
    mesh = pyvista.read(exported / f"bar_{number}.vtu")
    with h5py.File(spalled_run) as file:
        particles, snapshot = file["particles"], file["snapshots"][number]
        moved = snapshot["displacement"][:, 0]
        assert np.abs(moved).max() > 0.0
        np.testing.assert_array_equal(mesh.points[:, 0], particles["position"][:, 0] + moved)
        np.testing.assert_array_equal(mesh.points[:, 1:], 0.0)
        expected = {name: snapshot[name][:] for name in ("displacement", "velocity", "stress", "damage")}
        expected |= {"volume": particles["volume"][:], "id": np.arange(41), "peakVelocity": np.linspace(0.0, 3.0, 41)}
        expected = {name: values.astype(np.float32) for name, values in expected.items()}  # as they are written
    assert set(mesh.point_data.keys()) == set(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(mesh.point_data[name], values, err_msg=name)


def test_lines_join_neighbours_and_know_how_many_bonds_across_them_have_broken(spalled_run, exported):
    totals = []
    with h5py.File(spalled_run) as file:
        times, pairs = file["cracks/time"][:], file["cracks/particles"][:]
        for number, snapshot in file["snapshots"].items():
            mesh = pyvista.read(exported / f"bar_{number}.vtu")
            assert set(mesh.celltypes) == {pyvista.CellType.LINE}
            np.testing.assert_array_equal(mesh.cell_connectivity.reshape(-1, 2), [[k, k + 1] for k in range(40)])
            broken = pairs[times <= snapshot.attrs["time"]]
            counted = [sum(first <= k < last for first, last in broken) for k in range(40)]
            np.testing.assert_array_equal(mesh.cell_data["brokenBonds"], counted)
            totals.append(sum(counted))
    assert totals[0] == 0 < totals[-1]

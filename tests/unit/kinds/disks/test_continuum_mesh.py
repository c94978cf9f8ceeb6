"""Meshes of a continuum for ParaView equal the record, and have the colours of the disks."""

import h5py
import numpy as np
import pytest
import pyvista

from dembound.continuum.mesh import Around, Mesh
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.mesh import continuum_mesh
from dembound.results.vtk import write_paraview


@pytest.fixture(scope="module")
def exported(surrounded_run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("vtu") / "paraview"
    write_paraview(surrounded_run, folder, Disks())
    return folder


def test_vtk_reads_one_quadrilateral_per_cell(surrounded_run, exported) -> None:
    number = "0001"
    mesh = pyvista.read(exported / f"continuum_{number}.vtu")
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
    # without the box of the disks; displaced by a thousandth of a metre at random
    assert mesh.compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(30.0 * 15.0 - 12.0 * 6.0, rel=1e-2)


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
    corners = made.points[made.cells_dict["quad"], :2]
    across, up = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    areas = 0.5 * (across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0])
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(float(np.prod(mesh.size)), rel=1e-7)

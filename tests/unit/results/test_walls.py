"""Walls in the files of a run: record, pictures, and files for ParaView."""

from pathlib import Path

import meshio
import numpy as np
import pytest
from small_cases import small

import dembound
from dembound.plot.moving import MovingScene
from dembound.running import run_case

FALLING = {
    "packing": {"pattern": "A", "size": [1.0, 0.5], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5, "dp_nratio": 0.3},
    "wall": [
        {"name": "floor", "points": [[-1.0, -0.01], [2.0, -0.01]], "fric": 0.5, "dp_nratio": 0.5},
        {"name": "plate", "points": [[3.0, 0.0], [3.0, 1.0], [4.0, 1.0]], "velocity": [1.0, 2.0]},
    ],
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "run": {"duration": 0.3},
    "output": {"snapshots": 2, "pictures": True, "contacts": True},
}
"""Two disks that fall by 10 mm, and a wall that nothing touches."""


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dembound.Results:
    return dembound.Results(run_case(small(FALLING, "falling"), tmp_path_factory.mktemp("walls")))


def test_forces_and_displacements_are_recorded(found) -> None:
    floor, plate = found.walls["floor"], found.walls["plate"]
    assert list(found.walls) == ["floor", "plate"]
    np.testing.assert_allclose(floor["points"], [[-1.0, -0.01], [2.0, -0.01]])
    assert floor["force"][0] == pytest.approx([0.0, 0.0])
    weight = 2 * 2500.0 * 0.5**2 * 9.81
    late = floor["time"] > 0.2
    assert floor["force"][late].mean(axis=0) == pytest.approx([0.0, -weight], rel=1e-3, abs=1e-3 * weight)
    np.testing.assert_allclose(plate["displacement"], plate["time"][:, None] * (1.0, 2.0), atol=1e-12)
    assert not plate["force"].any()
    assert abs(found.energy["relative_error"]).max() < 1e-9


def test_paraview_has_them_where_they_are(found) -> None:
    last = meshio.read(found.folder / "paraview" / "walls_0001.vtu")
    assert [cells.type for cells in last.cells] == ["line"]
    assert last.cells[0].data.tolist() == [[0, 1], [2, 3], [3, 4]]
    assert last.cell_data["wall"][0].tolist() == [0, 1, 1]
    time = found.snapshots[-1].attributes["time"]
    np.testing.assert_allclose(last.points[2], [3.0 + time, 2.0 * time, 0.0], atol=2e-3)


def test_pictures_draw_them(found) -> None:
    """At their place at the time, in movies with displacements."""
    assert (Path(found.folder) / "scene.png").exists()
    moving = MovingScene(found.folder / "run.h5", exaggerate=1.0)
    time = found.snapshots[-1].attributes["time"]
    moving.frame(1, 300)
    drawn = [line.get_xydata() for line in moving.figure.axes[0].lines]
    assert any(np.allclose(line[0], [3.0 + time, 2.0 * time], atol=2e-3) for line in drawn)

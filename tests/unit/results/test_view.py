"""Disks are shown in their true size and place, and a machine that cannot draw gets a message."""

import json
import subprocess
import sys
from dataclasses import dataclass

import h5py
import numpy as np
import pytest
from matplotlib import image
from small_cases import PUSHED, small
from translated import translated

from dembound.errors import CaseError, DemboundError
from dembound.motion.simulation import Simulation
from dembound.results import view as module
from dembound.results.recorder import Recorder
from dembound.results.view import (
    disk_mesh,
    extent_of,
    label_count,
    lengths,
    meshes_of,
    picture_size,
    require_rendering,
    view,
)
from dembound.running import plan


def test_every_disk_is_a_polygon_as_wide_and_high_as_itself():
    positions = np.array([[1.0, 2.0], [4.0, 3.0], [2.5, 8.0]])
    radii = np.array([0.5, 1.0, 0.25])
    disks = disk_mesh(positions, radii)
    assert disks.n_cells == 3
    # VTK keeps glyph points in single precision: 6e-8 of coordinates up to 8 m, twice in a width
    for index, (place, radius) in enumerate(zip(positions, radii, strict=True)):
        bounds = np.reshape(disks.get_cell(index).bounds, (3, 2))
        np.testing.assert_allclose(np.diff(bounds)[:, 0], [2.0 * radius, 2.0 * radius, 0.0], atol=1e-6)
        np.testing.assert_allclose(bounds.mean(axis=1)[:2], place, atol=1e-6)


def test_the_length_is_that_of_the_field_in_the_plane(small_run):
    with h5py.File(small_run) as file:
        snapshot = file["snapshots/0001"]
        for field in ("velocity", "displacement"):
            x, y, _ = snapshot[field][:].T
            np.testing.assert_array_equal(lengths(snapshot, field), np.hypot(x, y))


def test_axes_have_round_numbers_where_they_can():
    # 20 m are cut into fives, not into three times 6.67 m
    for length, share, count in ((100.0, 1.0, 6), (5.0, 0.05, 2), (20.0, 0.4, 6), (30.0, 0.4, 4), (17.3, 1.0, 6)):
        assert label_count(length, share) == count
    assert picture_size(np.array([100.0, 5.0])) == (1600, 357)  # low, as the scene is long
    assert picture_size(np.array([50.0, 50.0])) == (1600, 900)


def test_a_continuum_moves_and_is_coloured_as_disks_are(surrounded_run):
    with h5py.File(surrounded_run) as file:
        _, around = meshes_of(file)
        group = file["snapshots/0001"]
        around.show(group, "velocity", 7.0)
        nodes, moved = file["continuum/position"][:], group["continuum/displacement"][:]
        speed = np.hypot(*group["continuum/velocity"][:, :2].T)
        absorbs, cells = file["continuum/absorbs"][:], file["continuum/cell"][:]
        np.testing.assert_array_equal(extent_of(file), [[-9.0, -9.0], [21.0, 6.0]])
    # VTK keeps points in single precision: 6e-8 of 21 m
    np.testing.assert_allclose(around.mesh.points[:, :2], nodes + 7.0 * moved[:, :2], atol=2e-6)
    assert (around.mesh.points[:, 2] < 0.0).all()
    np.testing.assert_array_equal(around.mesh.point_data["speed (m/s)"], speed)
    np.testing.assert_array_equal(around.opacity < 1.0, absorbs)
    np.testing.assert_array_equal(around.mesh.faces.reshape(-1, 5)[:, 1:], cells)


def test_without_a_continuum_the_extent_is_that_of_the_disks_wherever_it_begins(tmp_path):
    planned = plan(translated(small(PUSHED), (-3.0, 2.0)))
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    with Recorder(tmp_path / "run.h5", simulation, planned.step_limit):
        pass
    with h5py.File(tmp_path / "run.h5") as file:
        assert len(meshes_of(file)) == 1
        np.testing.assert_array_equal(extent_of(file), [[-3.0, 2.0], [7.0, 4.5]])


def test_without_opengl_there_is_one_line_instead_of_a_crash(small_run, spalled_run, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "TRIAL", "import os; os.abort()")
    with pytest.raises(DemboundError, match="no working OpenGL"):
        view(small_run, picture=tmp_path / "picture.png")
    assert not list(tmp_path.iterdir())
    # what cannot be shown is refused before that
    with pytest.raises(CaseError, match="no snapshot 5, they are 0 to 1"):
        view(small_run, snapshot=5)
    with pytest.raises(CaseError, match="is a bar, view shows disks; `dembound plot RESULTS --field stress`"):
        view(spalled_run)


@pytest.mark.parametrize("drawn_in", module.WINDOWLESS)
def test_without_a_display_only_pictures_are_drawn(monkeypatch, drawn_in):
    monkeypatch.setattr(module, "TRIAL", f"print('{drawn_in}')")
    require_rendering(in_window=False)
    with pytest.raises(DemboundError, match=r"no display .* DISPLAY .* --output picture\.png, .* ParaView"):
        require_rendering(in_window=True)


DRAW = """
import json, sys
from dembound.cli import main
from dembound.results import view
for arguments in json.loads(sys.argv[1]):
    sys.argv = ["dembound", "view", *arguments]
    try:
        main()
    except SystemExit as ended:
        if ended.code:
            raise
    view.TRIAL = ""
"""
"""Does one command after the other, in a process of its own; what the first has tried, the others need not."""

CRACK = 7.75, 1.25

HEIGHT = 586
"""Height of the pictures, pixels: that of the scene, 1600 / 1.4 · 2.5 / 10, and 300 around it."""


@dataclass
class Drawn:
    """Pictures (rows, columns, 3) of a run, by name, and the names of all files beside them.

    The run is at rest but for the left half in the last of two snapshots, at 2 m/s. All disks have moved by 20 mm along
    x. It has one crack, put into a disk at CRACK, at the time of the last snapshot. The scene, 10 m × 2.5 m, is
    1600 / 1.4 pixels wide and lies in the middle.
    """

    pictures: dict[str, np.ndarray]
    files: set[str]

    def cracks(self, name: str) -> np.ndarray:
        """Rows and columns (k, 2) of pixels in the colour of cracks, which no disk has."""
        picture = self.pictures[name]
        return np.argwhere(picture[..., 0] - picture[..., 1] > 0.5)


@pytest.fixture(scope="module")
def drawn(cracked_run, surrounded_run, tmp_path_factory) -> Drawn:
    """Drawn by the commands in one process, for most of their time goes into imports; skips where VTK cannot draw."""
    folder = tmp_path_factory.mktemp("drawn")
    run = folder / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for snapshot in file["snapshots"].values():
            snapshot["velocity"][:] = 0.0
            snapshot["displacement"][:] = 0.02, 0.0, 0.0
        snapshot["velocity"][np.flatnonzero(file["particles/position"][:, 0] < 5.0), 0] = 2.0
        for dataset in file["cracks"].values():
            dataset.resize(1, axis=0)
        file["cracks/time"][0] = snapshot.attrs["time"]
        file["cracks/position"][0] = CRACK
    options = {"first": ["--snapshot", "0"], "last": [], "moved": ["--snapshot", "-1", "--exaggerate", "50"]}
    commands = [[str(run), "--picture", str(folder / f"{name}.png"), *more] for name, more in options.items()]
    around = folder / "around.h5"
    around.write_bytes(surrounded_run.read_bytes())
    with h5py.File(around, "r+") as file:
        for group in (file["snapshots/0000"], file["snapshots/0000/continuum"]):
            group["velocity"][:] = 1.0, 0.0, 0.0
    commands.append([str(around), "--picture", str(folder / "around.png"), "--snapshot", "0"])
    command = [sys.executable, "-c", DRAW, json.dumps(commands)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    if "no working OpenGL" in done.stderr:
        pytest.skip(done.stderr)
    assert (done.returncode, done.stderr) == (0, "")
    pictures = {name: image.imread(folder / f"{name}.png")[..., :3] for name in (*options, "around")}
    return Drawn(pictures, {path.name for path in folder.iterdir()})


def test_cracks_are_shown_up_to_their_snapshot(drawn):
    assert len(drawn.cracks("first")) == 0
    # a pixel of rounding
    expected = [0.5 * HEIGHT, 800.0 + (CRACK[0] - 5.0) * 1600.0 / 14.0]
    np.testing.assert_allclose(drawn.cracks("last").mean(axis=0), expected, atol=1.0)


def test_exaggerated_displacements_move_disks_and_cracks_with_them(drawn):
    # they end 1 m to the right: from the axes' 0 to there, 11 m are 1600 / 1.4 pixels wide and lie in the middle
    column = 800.0 + (np.array([0.05, 0.95, 1.05, 10.95, CRACK[0] + 1.0]) - 5.5) * 1600.0 / 15.4
    inked = (
        np.ptp(drawn.pictures["moved"][HEIGHT // 2 - 130 : HEIGHT // 2 + 130], axis=2) > 0.1
    )  # coloured, not white or black
    left, before, after, end, crack = column.round().astype(int)
    assert not inked[:, left:before].any()
    # disks in a square lattice fill π/4, their polygons 1.1 % less; half a pixel on their rims, whose radius is 26, is
    # 3.8 % of them; and the ends that are left out, where there is less of them, are 1 % of the length
    assert inked[:, after:end].mean() == pytest.approx(np.pi / 4, rel=0.06)
    np.testing.assert_allclose(drawn.cracks("moved").mean(axis=0), [0.5 * HEIGHT, crack], atol=1.5)


def test_a_picture_shows_the_snapshot_asked_for(drawn):
    first, last = (drawn.pictures[name] for name in ("first", "last"))
    assert first.shape == last.shape == (HEIGHT, 1600, 3)
    assert drawn.files == {"around.h5", "around.png", "first.png", "last.png", "moved.png", "run.h5"}
    changed = np.abs(first - last).max(axis=2) > 0.5  # from the dark to the bright end of the scale
    row, column = drawn.cracks("last").mean(axis=0).round().astype(int)
    changed[row - 7 : row + 8, column - 7 : column + 8] = False  # the crack itself, 10 pixels wide
    left, right = (
        changed[HEIGHT // 2 - 143 : HEIGHT // 2 + 143, half].mean() for half in (slice(229, 800), slice(800, 1371))
    )
    # disks in a square lattice fill π/4 of it, their polygons 1.1 % less; pixels on the rim of a disk, whose radius
    # is 28.6 of them, move it by half a pixel at most, 3.5 % of the area
    assert left == pytest.approx(np.pi / 4, rel=0.046)
    assert right == 0.0


def test_disks_and_continuum_of_one_speed_have_one_colour(drawn):
    """The scene of 30 m × 15 m is 1600 / 1.4 pixels wide, with its middle, (6, −1.5) m, in the middle."""
    picture = drawn.pictures["around"]
    rows, columns = picture.shape[:2]
    scale = columns / 1.4 / 30.0

    def colour(x: float, y: float) -> np.ndarray:
        return picture[round(0.5 * rows - scale * (y + 1.5)), round(0.5 * columns + scale * (x - 6.0))]

    for x, y in [(-1.2, 2.2), (13.3, 1.7), (4.3, -1.4), (-1.6, -1.2)]:  # the margin, away from outlines
        np.testing.assert_array_equal(colour(x, y), colour(6.5, 3.5))
    assert (colour(-4.4, 2.2) > colour(6.5, 3.5)).any()  # pale where it absorbs

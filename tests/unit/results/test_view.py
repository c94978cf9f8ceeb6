"""Disks are shown in their true size and place, and a machine that cannot draw is told so."""

import subprocess
import sys

import h5py
import numpy as np
import pytest
from matplotlib import image

from dembound.errors import CaseError, DemboundError
from dembound.results import view as module
from dembound.results.view import disk_mesh, lengths, require_rendering, view


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


def test_without_opengl_there_is_one_line_instead_of_a_crash(small_run, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "TRIAL", "import os; os.abort()")
    with pytest.raises(DemboundError, match="no working OpenGL"):
        view(small_run, picture=tmp_path / "picture.png")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("drawn_in", module.WINDOWLESS)
def test_without_a_display_only_pictures_are_drawn(monkeypatch, drawn_in):
    monkeypatch.setattr(module, "TRIAL", f"print('{drawn_in}')")
    require_rendering(in_window=False)
    with pytest.raises(DemboundError, match=r"no display .* --picture"):
        require_rendering(in_window=True)


def test_a_missing_snapshot_is_refused_before_anything_is_drawn(small_run, monkeypatch):
    monkeypatch.setattr(module, "TRIAL", "raise SystemExit(1)")
    with pytest.raises(CaseError, match="no snapshot 5, they are 0 to 1"):
        view(small_run, snapshot=5)


def test_bars_are_refused_with_the_command_that_draws_them(spalled_run):
    with pytest.raises(CaseError, match="is a bar, view shows disks; `dembound plot RESULTS --field stress`"):
        view(spalled_run)


@pytest.fixture(scope="module")
def drawing():
    """Skips where VTK cannot draw without a window."""
    try:
        require_rendering(in_window=False)
    except DemboundError as error:
        pytest.skip(str(error))


def drawn(run, path, *options):
    """The picture (rows, columns, 3) that the command leaves, in a process of its own."""
    command = [sys.executable, "-m", "dembound", "view", str(run), "--picture", str(path), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return image.imread(path)[..., :3]


@pytest.mark.usefixtures("drawing")
def test_cracks_are_shown_up_to_their_snapshot(cracked_run, tmp_path):
    # a run at rest, of which only the first crack is left, moved into a disk and to the time of the last snapshot
    run = tmp_path / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for snapshot in file["snapshots"].values():
            snapshot["velocity"][:] = 0.0
        for dataset in file["cracks"].values():
            dataset.resize(1, axis=0)
        file["cracks/time"][0] = snapshot.attrs["time"]
        file["cracks/position"][0] = 7.75, 1.25
    red = [
        np.argwhere(picture[..., 0] - picture[..., 1] > 0.5)
        for picture in (drawn(run, tmp_path / "picture.png", "--snapshot", str(number)) for number in (0, 1))
    ]
    assert len(red[0]) == 0
    # the scene, 10 m × 2.5 m, is 1600 / 1.4 pixels wide and lies in the middle; a pixel of rounding
    np.testing.assert_allclose(red[1].mean(axis=0), [450.0, 800.0 + (7.75 - 5.0) * 1600.0 / 14.0], atol=1.0)


@pytest.mark.usefixtures("drawing")
def test_exaggerated_displacements_move_disks_and_cracks_with_them(cracked_run, tmp_path):
    # disks at rest, all moved by 20 mm along x, and the first crack, put between them
    run = tmp_path / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for snapshot in file["snapshots"].values():
            snapshot["velocity"][:] = 0.0
            snapshot["displacement"][:] = 0.02, 0.0, 0.0
        for dataset in file["cracks"].values():
            dataset.resize(1, axis=0)
        file["cracks/time"][0] = snapshot.attrs["time"]
        file["cracks/position"][0] = 7.75, 1.25
    picture = drawn(run, tmp_path / "picture.png", "--snapshot", "-1", "--exaggerate", "50")
    # they end 1 m to the right: from the axes' 0 to there, 11 m are 1600 / 1.4 pixels wide and lie in the middle
    column = 800.0 + (np.array([0.05, 0.95, 1.05, 10.95, 8.75]) - 5.5) * 1600.0 / 15.4
    inked = np.ptp(picture[320:580], axis=2) > 0.1  # coloured, not white or black
    left, before, after, end, crack = column.round().astype(int)
    assert not inked[:, left:before].any()
    # disks in a square lattice fill π/4, their polygons 1.1 % less; half a pixel on their rims, whose radius is 26, is
    # 3.8 % of them; and the ends that are left out, where there is less of them, are 1 % of the length
    assert inked[:, after:end].mean() == pytest.approx(np.pi / 4, rel=0.06)
    red = np.argwhere(picture[..., 0] - picture[..., 1] > 0.5)
    np.testing.assert_allclose(red.mean(axis=0), [450.0, crack], atol=1.5)


@pytest.mark.usefixtures("drawing")
def test_a_picture_shows_the_snapshot_asked_for(small_run, tmp_path):
    # a run at rest but for the left half in the last snapshot
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for snapshot in file["snapshots"].values():
            snapshot["velocity"][:] = 0.0
        left = np.flatnonzero(file["particles/position"][:, 0] < 5.0)
        snapshot["velocity"][left, 0] = 2.0
    first = drawn(run, tmp_path / "first.png", "--snapshot", "0")
    last = drawn(run, tmp_path / "last.png")
    assert first.shape == last.shape == (900, 1600, 3)
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["first.png", "last.png", "run.h5"]
    # the scene, 10 m × 2.5 m, is 1600 / 1.4 pixels wide and lies in the middle
    rows, halves = slice(307, 593), (slice(229, 800), slice(800, 1371))
    changed = np.abs(first - last).max(axis=2) > 0.5  # from the dark to the bright end of the scale
    left, right = (changed[rows, half].mean() for half in halves)
    # disks in a square lattice fill π/4 of it, their polygons 1.1 % less; pixels on the rim of a disk, whose radius
    # is 28.6 of them, move it by half a pixel at most, 3.5 % of the area
    assert left == pytest.approx(np.pi / 4, rel=0.046)
    assert right == 0.0

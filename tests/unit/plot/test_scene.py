"""Scenes show every disk, or their mean where disks are too small."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection

from dembound.errors import CaseError
from dembound.plot.scene import plot_scene


def disks_of(panel):
    (disks,) = [each for each in panel.collections if isinstance(each, EllipseCollection)]
    return disks


def block(path, columns, rows, velocity):
    """A record of columns × rows disks of diameter 1 m with one snapshot; velocity (x of the disks) in m/s."""
    x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5, indexing="ij")
    positions = np.column_stack([x.ravel(), y.ravel()])
    motion = np.zeros((len(positions), 3))
    motion[:, 0] = velocity(positions[:, 0])
    with h5py.File(path, "w") as file:
        file.attrs["name"] = "block"
        file["particles/position"], file["particles/radius"] = positions, np.full(len(positions), 0.5)
        file["snapshots/0000/velocity"], file["snapshots/0000/displacement"] = motion, motion
        file["snapshots/0000"].attrs["time"] = 0.5
    return path


@pytest.mark.parametrize(
    ("arguments", "number", "column", "label"),
    [
        ({}, "0001", 0, "velocity along x (m/s)"),
        ({"snapshot": 0, "component": "y"}, "0000", 1, "velocity along y (m/s)"),
        ({"field": "displacement", "component": "rotation"}, "0001", 2, "displacement of rotation (rad)"),
    ],
)
def test_disks_have_true_sizes_places_and_values(small_run, arguments, number, column, label):
    figure = plot_scene(small_run, **arguments)
    panel, bar = figure.axes
    disks = disks_of(panel)
    field = arguments.get("field", "velocity")
    with h5py.File(small_run) as file:
        np.testing.assert_array_equal(disks.get_offsets(), file["particles/position"][:])
        np.testing.assert_array_equal(disks.get_array(), file[f"snapshots/{number}/{field}"][:, column])
        time = file[f"snapshots/{number}"].attrs["time"]
    np.testing.assert_array_equal(disks.get_widths(), 0.5)
    assert disks.get_clim() == (-np.abs(disks.get_array()).max(), np.abs(disks.get_array()).max())
    assert bar.get_ylabel() == label
    assert f"t = {time:.4g} s" in figure.get_suptitle()
    assert (panel.get_xlabel(), panel.get_ylabel(), panel.get_aspect()) == ("x (m)", "y (m)", 1.0)


def test_monitors_are_named_where_they_are(small_run):
    panel = plot_scene(small_run).axes[0]
    with h5py.File(small_run) as file:
        places = {name: tuple(group.attrs["position"]) for name, group in file["histories"].items()}
    assert {text.get_text(): tuple(text.xy) for text in panel.texts} == places


def test_small_disks_give_way_to_their_mean(tmp_path):
    # 600 columns on 9.5 inches of 150 pixels are 2.4 pixels each, below the 3 that a disk needs
    run = block(tmp_path / "run.h5", 600, 100, lambda x: x)
    panel = plot_scene(run).axes[0]
    (picture,) = panel.images
    # cells of two diameters hold the columns (2k + 0.5, 2k + 1.5), of mean 2k + 1
    np.testing.assert_allclose(picture.get_array()[0], 2.0 * np.arange(300) + 1.0)
    assert picture.get_array().shape == (50, 300)
    assert not [each for each in panel.collections if isinstance(each, EllipseCollection)]


def test_a_long_scene_gets_a_close_up_on_the_flank_of_the_wave(tmp_path):
    run = block(tmp_path / "run.h5", 1000, 50, lambda x: np.exp(-(((x - 300.0) / 50.0) ** 2)))
    whole, part, _ = plot_scene(run).axes
    assert len(whole.images) == 1
    left, right = part.get_xlim()
    # half the largest motion is 50 √ln 2 = 41.6 m from the crest
    assert min(abs(0.5 * (left + right) - 300.0 - side) for side in (-41.6, 41.6)) < 1.0
    assert right - left == pytest.approx(3.0 * np.ptp(part.get_ylim()))
    (frame,) = whole.patches
    assert frame.get_extents().get_points() == pytest.approx(
        whole.transData.transform([[left, part.get_ylim()[0]], [right, part.get_ylim()[1]]])
    )
    disks = disks_of(part)
    assert np.all(np.abs(disks.get_offsets()[:, 0] - 0.5 * (left + right)) < 0.5 * (right - left) + 0.5)


def test_an_upright_scene_has_its_close_up_beside_it(tmp_path):
    whole, part, _ = plot_scene(block(tmp_path / "run.h5", 10, 200, lambda x: x)).axes
    assert np.ptp(part.get_ylim()) > np.ptp(part.get_xlim())
    assert whole.get_position().x1 < part.get_position().x0


def test_a_scene_at_rest_is_drawn(tmp_path):
    disks = disks_of(plot_scene(block(tmp_path / "run.h5", 5, 4, np.zeros_like)).axes[0])
    assert disks.get_clim() == (-1.0, 1.0)


@pytest.mark.parametrize("snapshot", [2, -3])
def test_a_missing_snapshot_is_refused(small_run, snapshot):
    with pytest.raises(CaseError, match=f"no snapshot {snapshot}, it has 2"):
        plot_scene(small_run, snapshot)

"""Scenes show every disk, or their mean where disks are too small; long ones at several moments."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection

from dembound.errors import CaseError
from dembound.plot.scene import plot_scene


def disks_of(panel):
    (disks,) = [each for each in panel.collections if isinstance(each, EllipseCollection)]
    return disks


def block(path, columns, rows, *velocities):
    """A record of columns × rows disks of diameter 1 m; a velocity (x of the disks) in m/s per snapshot, each 0.5 s."""
    x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5, indexing="ij")
    positions = np.column_stack([x.ravel(), y.ravel()])
    with h5py.File(path, "w") as file:
        file.attrs["name"] = "block"
        file["cracks/time"], file["cracks/position"], file["cracks/shear"] = [], np.zeros((0, 2)), np.zeros(0, bool)
        file["particles/position"], file["particles/radius"] = positions, np.full(len(positions), 0.5)
        for number, velocity in enumerate(velocities):
            group = file.create_group(f"snapshots/{number:04d}")
            group["velocity"] = np.column_stack([velocity(positions[:, 0]), np.zeros((len(positions), 2))])
            group.attrs["time"] = 0.5 * (number + 1)
    return path


def pulse(place, height=1.0):
    """A velocity: a pulse some 100 m long around x = place."""
    return lambda x: height * np.exp(-(((x - place) / 50.0) ** 2))


def times_beside(panels):
    """Texts at the right end of each panel."""
    return [text.get_text() for panel in panels for text in panel.texts if text.xyann == (8, 0)]


@pytest.mark.parametrize(
    ("arguments", "number", "column", "label"),
    [
        ({}, "0001", 0, "velocity along x (m/s)"),
        ({"snapshot": 0, "component": "y"}, "0000", 1, "velocity along y (m/s)"),
        ({"field": "displacement", "component": "rotation"}, "0001", 2, "displacement of rotation (rad)"),
    ],
)
def test_disks_and_monitors_have_true_sizes_places_and_values(small_run, arguments, number, column, label):
    panel, bar = plot_scene(small_run, **arguments).axes
    disks = disks_of(panel)
    field = arguments.get("field", "velocity")
    with h5py.File(small_run) as file:
        np.testing.assert_array_equal(disks.get_offsets(), file["particles/position"][:])
        np.testing.assert_array_equal(disks.get_array(), file[f"snapshots/{number}/{field}"][:, column])
        time = file[f"snapshots/{number}"].attrs["time"]
        limit = max(np.abs(each[field][:, column]).max() for each in file["snapshots"].values())
        places = {name: tuple(group.attrs["position"]) for name, group in file["histories"].items()}
    np.testing.assert_array_equal(disks.get_widths(), 0.5)
    assert disks.get_clim() == (-limit, limit)
    assert (bar.get_ylabel(), panel.get_title()) == (label, f"t = {time:.3g} s")
    assert {text.get_text(): tuple(text.xy) for text in panel.texts} == places


@pytest.mark.parametrize(("field", "column"), [("stress_xx", 0), ("stress_yy", 1), ("stress_xy", 2)])
def test_stresses_are_shown_where_they_are_largest(rich_run, field, column):
    panel, bar = plot_scene(rich_run, field=field).axes
    with h5py.File(rich_run) as file:
        stresses = [each["stress"][:, column] for each in file["snapshots"].values()]
    stress = max(stresses, key=lambda values: np.abs(values).max())
    np.testing.assert_array_equal(disks_of(panel).get_array(), stress / 1e6)
    sense = "positive up on a face to the right" if field == "stress_xy" else "tension positive"
    assert bar.get_ylabel() == f"stress {field[-2:]}, {sense} (MPa)"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"field": "stress_xy"}, "holds no stress; runs with output.stress = true do"),
        ({"field": "peak"}, "holds no peaks; complete runs with output.peaks = true do"),
        ({"field": "peak", "snapshot": 0}, "peak: is of the whole run"),
        ({"field": "damage"}, "field: is damage, must be one of velocity, displacement, stress_xx"),
        ({"snapshot": -3}, "no snapshot -3, they are 0 to 1"),
    ],
)
def test_what_was_not_kept_is_refused(small_run, other_run, arguments, said):
    with pytest.raises(CaseError, match=said):
        plot_scene(small_run, **arguments)
    with pytest.raises(CaseError, match=r"has no snapshots, run with output\.snapshots above 0"):
        plot_scene(other_run)


@pytest.mark.parametrize("snapshot", [0, 1])
def test_bonds_broken_by_then_are_marked_by_how_they_broke_above_the_disks(cracked_run, snapshot):
    panel = plot_scene(cracked_run, snapshot).axes[0]
    marks = {each.get_label(): each for each in panel.collections if "bond" in each.get_label()}
    with h5py.File(cracked_run) as file:
        cracks = file["cracks"]
        past = cracks["time"][:] <= file[f"snapshots/{snapshot:04d}"].attrs["time"]
        for label, shear in (("bond broken in tension", False), ("bond broken in shear", True)):
            first, second = cracks["particles"][:][past & (cracks["shear"][:] == shear)].T
            position, radius = (file["particles"][name][:] for name in ("position", "radius"))
            to_contact = (radius[first] / (radius[first] + radius[second]))[:, None]
            expected = position[first] + to_contact * (position[second] - position[first])
            lines = np.array(marks[f"{label} ({len(expected)})"].get_segments())
            np.testing.assert_allclose(lines.mean(axis=1), expected, rtol=1e-12)
            assert len(expected) > 0


def test_colours_span_the_disks_but_for_few_that_are_a_quarter_beyond_their_scale(tmp_path):
    """One thrown disk of 800 has a colour beyond the bar, whose ends say so."""
    for thrown, end, extend in ((570.0, 2.0, "both"), (2.4, 2.4, "neither")):
        path = block(tmp_path / "run.h5", 40, 20, lambda x: np.where(x > 20.0, 2.0, -1.0))
        with h5py.File(path, "a") as file:
            file["snapshots/0000/velocity"][17, 0] = thrown
        panel, bar = plot_scene(path).axes
        assert disks_of(panel).get_clim() == (-end, end)
        assert bar._colorbar.extend == extend


def test_moved_disks_are_drawn_where_they_are_in_a_frame_without_those_far_away(tmp_path):
    """Of 4,000 disks one is 300 m away: the frame ends where the others are, and its title says so."""
    path = block(tmp_path / "run.h5", 80, 50, lambda x: x)
    shift = np.tile([7.0, 0.0, 0.0], (4000, 1))
    shift[0, 0] = 300.0
    with h5py.File(path, "a") as file:
        file["snapshots/0000/displacement"] = shift
        first = file["particles/position"][:]
    panel = plot_scene(path).axes[0]
    assert len(disks_of(panel).get_offsets()) == 3999
    np.testing.assert_array_equal(disks_of(panel).get_offsets(), first[1:] + shift[1:, :2])
    assert panel.get_xlim() == (0.0, 87.0)
    assert panel.get_title() == "t = 0.5 s, 1 disk farther away"
    panel = plot_scene(path, exaggerate=0.0).axes[0]
    np.testing.assert_array_equal(disks_of(panel).get_offsets(), first)
    assert (panel.get_xlim(), panel.get_title()) == ((0.0, 80.0), "t = 0.5 s")


def test_small_disks_give_way_to_their_mean(run):
    # 600 columns on 9.5 inches of 150 pixels are 2.4 pixels each, below the 4 that a disk needs
    panel = plot_scene(block(run, 600, 100, lambda x: x)).axes[0]
    (picture,) = panel.images
    # cells of two diameters hold the columns (2k + 0.5, 2k + 1.5), of mean 2k + 1
    np.testing.assert_allclose(picture.get_array()[0], 2.0 * np.arange(300) + 1.0)
    assert picture.get_array().shape == (50, 300)


def test_a_long_scene_shows_the_pulse_pass_and_leave_in_one_scale(run):
    # the second snapshot moves most, though backwards; in the last the pulse has left but for 1 mm/s
    motions = [pulse(200.0), pulse(500.0, -2.0), pulse(800.0), pulse(500.0, 1e-3)]
    *strips, part, _ = plot_scene(block(run, 1000, 20, *motions)).axes
    assert times_beside(strips) == ["t = 0.5 s", "t = 1 s", "t = 1.5 s", "t = 2 s"]
    for strip, motion in zip(strips, motions, strict=True):
        (picture,) = strip.images
        assert picture.get_clim() == disks_of(part).get_clim()
        assert strip.get_xlim() == (0.0, 1000.0)
        # cells of two diameters hold the disks centred at 2k + 0.5 and 2k + 1.5
        expected = motion(np.arange(1000) + 0.5).reshape(-1, 2).mean(axis=1)
        np.testing.assert_allclose(picture.get_array()[0], expected, atol=1e-15)
    assert disks_of(part).get_clim() == pytest.approx((-2.0, 2.0), rel=1e-3)  # no disk stands on the crest itself
    # one that is asked for is alone, in the colours of the run, with a close-up on its own flank
    whole, part, _ = plot_scene(run, 3).axes
    assert disks_of(part).get_clim() == whole.images[0].get_clim() == pytest.approx((-2.0, 2.0), rel=1e-3)
    left, right = part.get_xlim()
    # half the largest motion is 50 √ln 2 = 41.6 m from the crest
    assert abs(abs(0.5 * (left + right) - 500.0) - 41.6) < 1.0

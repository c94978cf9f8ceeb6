"""Scenes show every disk, or their mean where disks are too small; long ones at several moments."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection

from dembound.errors import CaseError
from dembound.plot.disks import Window
from dembound.plot.scene import BESIDE_MARK, name_sides, plot_scene, strips_on_page


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
    """What stands at the right end of each panel."""
    return [text.get_text() for panel in panels for text in panel.texts if text.xyann == (8, 0)]


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
        limit = max(np.abs(each[field][:, column]).max() for each in file["snapshots"].values())
    np.testing.assert_array_equal(disks.get_widths(), 0.5)
    assert disks.get_clim() == (-limit, limit)
    assert bar.get_ylabel() == label
    assert panel.get_title() == f"t = {time:.3g} s"
    assert (panel.get_xlabel(), panel.get_ylabel(), panel.get_aspect()) == ("x (m)", "y (m)", 1.0)


@pytest.mark.parametrize(("field", "column"), [("stress_xx", 0), ("stress_yy", 1), ("stress_xy", 2)])
def test_stresses_are_shown_where_they_are_largest(rich_run, field, column):
    panel, bar = plot_scene(rich_run, field=field).axes
    with h5py.File(rich_run) as file:
        stresses = [(each["stress"][:, column], each.attrs["time"]) for each in file["snapshots"].values()]
    stress, time = max(stresses, key=lambda pair: np.abs(pair[0]).max())
    disks = disks_of(panel)
    np.testing.assert_array_equal(disks.get_array(), stress / 1e6)
    assert disks.get_clim() == (-np.abs(stress).max() / 1e6, np.abs(stress).max() / 1e6)
    sense = "positive up on a face to the right" if field == "stress_xy" else "tension positive"
    assert bar.get_ylabel() == f"stress {field[-2:]}, {sense} (MPa)"
    assert panel.get_title() == f"t = {time:.3g} s"


def test_peaks_are_those_of_the_whole_run(rich_run):
    panel, bar = plot_scene(rich_run, field="peak").axes
    with h5py.File(rich_run) as file:
        peaks, duration = file["particles/peak_velocity"][:], file.attrs["steps"] * file.attrs["time_step"]
    disks = disks_of(panel)
    np.testing.assert_array_equal(disks.get_array(), peaks)
    assert disks.get_clim() == (0.0, peaks.max())
    assert bar.get_ylabel() == "largest speed (m/s)"
    assert panel.get_title() == f"t = 0 to {duration:.3g} s"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"field": "stress_xy"}, "holds no stress; runs with output.stress = true do"),
        ({"field": "peak"}, "holds no peaks; complete runs with output.peaks = true do"),
        ({"field": "peak", "snapshot": 0}, "peak: is of the whole run"),
    ],
)
def test_a_field_that_was_not_kept_is_refused(small_run, arguments, said):
    with pytest.raises(CaseError, match=said):
        plot_scene(small_run, **arguments)


@pytest.mark.parametrize("snapshot", [0, 1])
def test_bonds_broken_by_then_are_marked_by_how_they_broke(cracked_run, snapshot):
    figure = plot_scene(cracked_run, snapshot)
    marks = {each.get_label(): each.get_offsets() for each in figure.axes[0].collections if "bond" in each.get_label()}
    with h5py.File(cracked_run) as file:
        cracks = file["cracks"]
        past = cracks["time"][:] <= file[f"snapshots/{snapshot:04d}"].attrs["time"]
        for label, shear in (("bond broken in tension", False), ("bond broken in shear", True)):
            expected = cracks["position"][past & (cracks["shear"][:] == shear)]
            np.testing.assert_array_equal(marks[f"{label} ({len(expected)})"], expected)
            assert len(expected) > 0


def test_marks_of_broken_bonds_lie_above_the_disks(cracked_run):
    panel = plot_scene(cracked_run).axes[0]
    marks = [each for each in panel.collections if "bond" in each.get_label()]
    assert min(each.get_zorder() for each in marks) > disks_of(panel).get_zorder()


def test_twins_are_hollow_marks_without_names(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file.copy("histories/front", file["histories"], "front.free_field")
        file.copy("histories/back", file["histories"], "back.free_field")  # where its monitor is: not shown
        place = file["histories/front"].attrs["position"] - [0.5, 0.0]
        file["histories/front.free_field"].attrs["position"] = place
    panel = plot_scene(run).axes[0]
    assert [text.get_text() for text in panel.texts] == ["front", "back"]
    (twins,) = [each for each in panel.collections if each.get_label() == "its twin in the free field"]
    np.testing.assert_array_equal(twins.get_offsets(), [place])


def test_names_give_way_to_each_other():
    # 20 letters are 108 points wide: the second would cover the first, 30 points to the left, and goes below its mark
    above, below = name_sides(np.array([[100.0, 100.0], [130.0, 100.0]]), [20, 20])
    assert above == BESIDE_MARK[0]
    assert below == BESIDE_MARK[1]
    assert name_sides(np.array([[100.0, 100.0], [300.0, 100.0]]), [20, 20]) == [BESIDE_MARK[0]] * 2


def test_the_title_tells_when_the_law_changed(small_run, cracked_run):
    with h5py.File(cracked_run) as file:
        began = file["laws/time"][1]
    assert plot_scene(cracked_run).get_suptitle().endswith(f"disks\nelastic law to {began:.3g} s, then linearpbond")
    assert plot_scene(small_run).get_suptitle().endswith("disks")


def test_monitors_are_named_where_they_are(small_run):
    panel = plot_scene(small_run).axes[0]
    with h5py.File(small_run) as file:
        places = {name: tuple(group.attrs["position"]) for name, group in file["histories"].items()}
    assert {text.get_text(): tuple(text.xy) for text in panel.texts} == places


def test_small_disks_give_way_to_their_mean(tmp_path):
    # 600 columns on 9.5 inches of 150 pixels are 2.4 pixels each, below the 4 that a disk needs
    run = block(tmp_path / "run.h5", 600, 100, lambda x: x)
    panel = plot_scene(run).axes[0]
    (picture,) = panel.images
    # cells of two diameters hold the columns (2k + 0.5, 2k + 1.5), of mean 2k + 1
    np.testing.assert_allclose(picture.get_array()[0], 2.0 * np.arange(300) + 1.0)
    assert picture.get_array().shape == (50, 300)
    assert not [each for each in panel.collections if isinstance(each, EllipseCollection)]


def test_a_long_scene_gets_a_close_up_on_the_flank_of_the_wave(tmp_path):
    run = block(tmp_path / "run.h5", 1000, 50, pulse(300.0))
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


def test_a_long_scene_shows_the_pulse_pass_and_leave_in_one_scale(tmp_path):
    # the second snapshot moves most, though backwards; in the last the pulse has left but for 1 mm/s
    motions = [pulse(200.0), pulse(500.0, -2.0), pulse(800.0), pulse(500.0, 1e-3)]
    figure = plot_scene(block(tmp_path / "run.h5", 1000, 20, *motions))
    *strips, part, _ = figure.axes
    assert times_beside(strips) == ["t = 0.5 s", "t = 1 s", "t = 1.5 s", "t = 2 s"]
    for strip, motion in zip(strips, motions, strict=True):
        (picture,) = strip.images
        assert picture.get_clim() == disks_of(part).get_clim()
        assert strip.get_xlim() == (0.0, 1000.0)
        # cells of two diameters hold the disks centred at 2k + 0.5 and 2k + 1.5
        expected = motion(np.arange(1000) + 0.5).reshape(-1, 2).mean(axis=1)
        np.testing.assert_allclose(picture.get_array()[0], expected, atol=1e-15)
    assert disks_of(part).get_clim() == pytest.approx((-2.0, 2.0), rel=1e-3)  # no disk stands on the crest itself
    assert [len(strip.patches) for strip in strips] == [0, 1, 0, 0]
    assert [strip.get_xlabel() for strip in strips] == ["", "", "", "x (m)"]


def test_strips_are_at_most_eight_evenly_picked_with_first_and_last(tmp_path):
    run = block(tmp_path / "run.h5", 200, 2, *[pulse(20.0 * number) for number in range(15)])
    assert times_beside(plot_scene(run).axes) == [f"t = {0.5 + number:.3g} s" for number in range(8)]


@pytest.mark.parametrize(("length", "strips"), [(6.0, 1), (6.5, 4), (30.0, 8), (1000.0, 8), (1.0 / 30.0, 1)])
def test_no_more_strips_than_fit_on_the_page(length, strips):
    # 9.5 in / 6.5 = 1.46 in a strip, 1.58 in with the gap, so 4 in 6.5 in
    assert strips_on_page(Window(np.zeros(2), np.array([length, 1.0]))) == strips


def test_a_snapshot_asked_for_is_shown_alone_in_the_colours_of_the_run(tmp_path):
    run = block(tmp_path / "run.h5", 1000, 20, pulse(200.0), pulse(500.0, 1e-3))
    figure = plot_scene(run, 1)
    whole, part, _ = figure.axes
    assert times_beside([whole]) == ["t = 1 s"]
    assert disks_of(part).get_clim() == whole.images[0].get_clim() == pytest.approx((-1.0, 1.0), rel=1e-3)
    # the close-up is on this snapshot's own flank
    assert abs(abs(np.mean(part.get_xlim()) - 500.0) - 41.6) < 1.0


def test_the_component_is_the_one_that_moves_most_in_the_run(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["snapshots/0000/velocity"][3, 1] = -7.0
    _, bar = plot_scene(run).axes
    assert bar.get_ylabel() == "velocity along y (m/s)"


def test_an_upright_scene_has_its_close_up_beside_it(tmp_path):
    whole, part, _ = plot_scene(block(tmp_path / "run.h5", 10, 200, lambda x: x)).axes
    assert np.ptp(part.get_ylim()) > np.ptp(part.get_xlim())
    assert whole.get_position().x1 < part.get_position().x0


def test_a_scene_at_rest_is_drawn(tmp_path):
    disks = disks_of(plot_scene(block(tmp_path / "run.h5", 5, 4, np.zeros_like)).axes[0])
    assert disks.get_clim() == (-1.0, 1.0)


def test_a_run_without_snapshots_is_refused(other_run):
    with pytest.raises(CaseError, match=r"has no snapshots, run with output\.snapshots above 0"):
        plot_scene(other_run)


@pytest.mark.parametrize("snapshot", [2, -3])
def test_a_missing_snapshot_is_refused(small_run, snapshot):
    with pytest.raises(CaseError, match=f"no snapshot {snapshot}, they are 0 to 1"):
        plot_scene(small_run, snapshot)


def test_a_field_that_only_bars_have_is_refused(small_run):
    with pytest.raises(CaseError, match="field: is damage, must be one of velocity, displacement, stress_xx"):
        plot_scene(small_run, field="damage")


def test_a_line_stands_between_the_column_and_the_body(tmp_path):
    run = block(tmp_path / "run.h5", 6, 4, np.zeros_like)
    with h5py.File(run, "r+") as file:
        file.attrs["column"] = 8
    (line,) = plot_scene(run).axes[0].lines
    assert list(line.get_xdata()) == [2.0, 2.0]  # two columns of four disks, each 1 m wide

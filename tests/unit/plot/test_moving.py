"""Moving pictures show every snapshot in the same axes, with disks at their true or exaggerated places."""

import h5py
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from dembound.plot.moving import MovingScene


def one(panel, kind):
    """The only collection of a kind in a panel."""
    (found,) = [each for each in panel.collections if isinstance(each, kind)]
    return found


def test_every_snapshot_is_drawn_with_its_own_values_in_the_same_axes(small_run):
    scene = MovingScene(small_run)
    with h5py.File(small_run) as file:
        groups = list(file["snapshots"].values())
        velocities = [group["velocity"][:, 0] for group in groups]
        np.testing.assert_array_equal(scene.times, [group.attrs["time"] for group in groups])
        positions = file["particles/position"][:]
    frames, axes = [], []
    for index in (1, 0):
        frames.append(scene.frame(index, 400))
        panel = scene.figure.axes[0]
        disks = one(panel, EllipseCollection)
        np.testing.assert_array_equal(disks.get_array(), velocities[index])
        np.testing.assert_array_equal(disks.get_offsets(), positions)
        axes.append((panel.get_position().bounds, panel.get_xlim(), panel.get_ylim()))
    assert axes[0] == axes[1]
    assert (frames[0] != frames[1]).any()
    np.testing.assert_array_equal(scene.frame(1, 400), frames[0])


def test_disks_and_cracks_are_moved_by_their_exaggerated_displacements(cracked_run):
    factor = 20.0
    scene = MovingScene(cracked_run, exaggerate=factor)
    scene.frame(1, 300)
    with h5py.File(cracked_run) as file:
        displacement = factor * file["snapshots/0001/displacement"][:, :2]
        moved = file["particles/position"][:] + displacement
        radius = file["particles/radius"][:]
        cracks = {name: file["cracks"][name][:] for name in ("time", "position", "particles", "shear")}
    broken = cracks["time"] <= scene.times[1]
    panel = scene.figure.axes[0]
    np.testing.assert_array_equal(one(panel, EllipseCollection).get_offsets(), moved)
    # in a long scene or not, no disk is cut: the axes are wider by the largest displacement
    assert (moved > np.array([panel.get_xlim()[0], panel.get_ylim()[0]])).all()
    assert (moved < np.array([panel.get_xlim()[1], panel.get_ylim()[1]])).all()
    cracked = {each.get_label(): each for each in panel.collections if isinstance(each, LineCollection)}
    # a crack is between its two disks, at the surface of the first
    for label, shear in (("bond broken in tension", False), ("bond broken in shear", True)):
        chosen = broken & (cracks["shear"] == shear)
        if chosen.any():
            first, second = cracks["particles"][chosen].T
            to_contact = (radius[first] / (radius[first] + radius[second]))[:, None]
            middle = np.array(cracked[label].get_segments()).mean(axis=1)
            np.testing.assert_allclose(middle, moved[first] + to_contact * (moved[second] - moved[first]), rtol=1e-12)

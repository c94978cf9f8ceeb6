"""Bricks show their seams, patterns their edges; force chains a line for every contact, as wide as its force."""

import h5py
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import to_hex

from dembound.plot.packing import PULL, PUSH, brick_disks, plot_brick, plot_chains

SIZE = np.array([4.0, 3.0])
POSITIONS = np.array([[2.0, 1.5], [3.9, 1.5], [0.1, 2.8], [0.5, 0.5]])  # inside, over a face, a corner, touching
RADII = np.array([0.5, 0.4, 0.3, 0.5])
NO_ROWS = np.zeros((4, 2), dtype=bool)


def drawn(panel):
    return [each for each in panel.collections if isinstance(each, EllipseCollection)]


def test_disks_that_cross_faces_come_in_again_as_followers():
    places, numbers, kinds = brick_disks(POSITIONS, RADII, NO_ROWS, SIZE)
    assert kinds.tolist() == ["interior", "controller", "controller", "interior", *["follower"] * 4]
    followers = {(int(n), *np.round(place, 9)) for n, place in zip(numbers[4:], places[4:], strict=True)}
    assert followers == {(1, -0.1, 1.5), (2, 4.1, 2.8), (2, 0.1, -0.2), (2, 4.1, -0.2)}
    rows = NO_ROWS.copy()
    rows[2, 0] = True
    assert brick_disks(POSITIONS, RADII, rows, SIZE)[2][2:4].tolist() == ["regular row", "interior"]


def test_a_brick_is_drawn_by_kinds_with_its_contacts():
    (panel,) = plot_brick(POSITIONS, RADII, NO_ROWS, SIZE, np.array([[1, 2]]), np.array([[1, 0]])).axes
    assert [len(each.get_offsets()) for each in drawn(panel)] == [2, 2, 4]
    (contacts,) = [each for each in panel.collections if isinstance(each, LineCollection)]
    np.testing.assert_allclose(contacts.get_segments()[0], [[3.9, 1.5], [4.1, 2.8]])


def of_type(figure, kind):
    """The only collection of a type."""
    (found,) = [each for each in figure.axes[0].collections if isinstance(each, kind)]
    return found


def row(path, forces, radius=0.5):
    """A record of disks in a row along x, each touching the next with a force; then the same twice as large."""
    count = len(forces) + 1
    with h5py.File(path, "w") as file:
        file.attrs["name"] = "row"
        file["particles/position"] = radius * np.column_stack([2.0 * np.arange(count) + 1.0, np.ones(count)])
        file["particles/radius"] = np.full(count, radius)
        for number in (2, 1):
            group = file.create_group(f"snapshots/{2 - number:04d}")
            group["displacement"] = np.tile([0.01 * number, 0.0, 0.0], (count, 1))
            group.attrs["time"] = 0.5 * number
            group["contacts/particles"] = np.column_stack([np.arange(count - 1), np.arange(1, count)])
            group["contacts/vector"] = np.tile([2.0 * radius, 0.0], (count - 1, 1))
            group["contacts/normal_force"] = number * np.asarray(forces)
    return path


def test_lines_lead_from_disk_to_disk_with_width_and_colour_of_their_force(tmp_path):
    forces = np.array([-3e3, 1e3, -2e3])
    figure = plot_chains(row(tmp_path / "run.h5", forces))
    lines, disks = of_type(figure, LineCollection), of_type(figure, EllipseCollection)

    begins = {tuple(np.round(ends[0], 9)): at for at, ends in enumerate(lines.get_segments())}
    # the first snapshot has the larger forces; its disks have moved by 0.02 m
    at = [begins[0.52 + number, 0.5] for number in range(3)]
    np.testing.assert_allclose(np.diff(lines.get_segments(), axis=1)[:, 0], [[1, 0]] * 3)
    widths = np.array(lines.get_linewidths())[at]
    # the largest force is above the one of which one contact in a hundred has more
    np.testing.assert_allclose(widths[1:] / np.abs(forces[1:]), widths[1] / 1e3)
    assert widths[0] > widths[2]
    assert [to_hex(lines.get_colors()[k]) for k in at] == [colour.lower() for colour in (PUSH, PULL, PUSH)]
    np.testing.assert_allclose(disks.get_offsets(), [[0.52 + number, 0.5] for number in range(4)])

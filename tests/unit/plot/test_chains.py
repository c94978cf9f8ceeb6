"""Force chains: a line for every contact, as wide as its force, where its disks are."""

import h5py
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import to_hex

from dembound.plot.packing import PULL, PUSH, plot_chains


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

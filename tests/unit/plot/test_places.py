"""Cracks lie across the bonds that were there, and move and turn with their disks until these have parted."""

import numpy as np
import pytest

from dembound.plot.disks import Window
from dembound.plot.places import crack_lines, framed

POSITIONS, RADII = np.array([[0.0, 0.0], [3.0, 0.0], [20.0, 0.0]]), np.array([1.0, 2.0, 1.0])


def lines(moved, factor=1.0, pair=(0, 1), place=(1.0, 0.0)):
    """The line of one crack."""
    cracks = {"particles": np.array([pair]), "position": np.array([place])}
    return crack_lines(cracks, POSITIONS, RADII, np.asarray(moved, float), factor)[0]


def test_a_crack_is_as_wide_as_the_smaller_disk_and_moves_with_both():
    still = np.zeros((3, 2))
    np.testing.assert_allclose(lines(still), [[1.0, -1.0], [1.0, 1.0]])
    # the second disk goes round the first by 90°: from (3, 0) to (0, 3); twice as far with a factor of 2
    turned = np.array([[0.0, 0.0], [-3.0, 3.0], [0.0, 0.0]])
    np.testing.assert_allclose(lines(turned), [[1.0, 1.0], [-1.0, 1.0]])
    slope = np.array([-6.0, -3.0]) / np.hypot(3.0, 6.0)  # across the way from (0, 0) to (-3, 6)
    np.testing.assert_allclose(lines(turned, 2.0), np.array([-1.0, 2.0]) + np.array([-slope, slope]))


def test_a_crack_is_drawn_between_its_disks_wherever_it_broke():
    moved = np.array([[5.0, -40.0], [5.0, -40.0], [0.0, 0.0]])
    np.testing.assert_allclose(lines(moved, place=(6.0, -20.0)), [[6.0, -41.0], [6.0, -39.0]])


def test_a_frame_has_all_disks_that_are_not_far_from_the_body():
    """201 disks slide by 30 m in a row; four that fall for 100 m are out of the frame, though 2 % of all."""
    start = np.stack([np.arange(201.0), np.zeros(201)], axis=1)
    moved = np.tile([30.0, 0.0], (201, 1))
    moved[::60] = 0.0, -150.0
    window = framed(Window.around(start, np.full(201, 0.5)), start, np.full(201, 0.5), [moved])
    assert window.extent == (-0.5, 229.5 + 1.0, -0.5, 0.5)


@pytest.mark.parametrize(("opening", "is_drawn"), [(0.85, True), (0.95, False)])
def test_a_crack_ends_where_its_disks_are_three_tenths_farther_apart_whatever_the_factor(opening, is_drawn):
    moved = [[0.0, 0.0], [opening, 0.0], [0.0, 0.0]]
    for factor in (0.0, 1.0, 100.0):
        assert np.isfinite(lines(moved, factor)).all() == is_drawn


def test_a_crack_across_periodic_sides_lies_at_its_contact():
    """The third disk, at 20, is beside the first one beyond sides 22 apart: their contact is at -1."""
    np.testing.assert_allclose(lines(np.zeros((3, 2)), 1.0, (0, 2), (-1.0, 0.0)), [[-1.0, 1.0], [-1.0, -1.0]])

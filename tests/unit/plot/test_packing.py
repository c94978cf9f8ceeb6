"""Bricks show their seams, patterns their edges."""

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from dembound.plot.packing import brick_disks, plot_brick

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

"""Bricks show their seams, patterns their edges."""

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection

from dembound.plot.packing import brick_disks, plot_brick, plot_patterns

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
    figure = plot_brick(POSITIONS, RADII, NO_ROWS, SIZE, np.array([[1, 2]]), np.array([[1, 0]]))
    (panel,) = figure.axes
    assert [len(each.get_offsets()) for each in drawn(panel)] == [2, 2, 4]
    assert len({tuple(each.get_facecolor()[0]) for each in drawn(panel)}) == 3
    (contacts,) = [each for each in panel.collections if isinstance(each, LineCollection)]
    np.testing.assert_allclose(contacts.get_segments()[0], [[3.9, 1.5], [4.1, 2.8]])
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"interior (2)", "controller (2)", "follower (4)", "faces of the brick", "contact"} == set(texts)
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x (m)", "y (m)")


@pytest.mark.parametrize(("side", "axis", "face"), [("right", 0, 20.0), ("bottom", 1, 0.0)])
def test_patterns_show_their_edge_in_another_colour(side, axis, face):
    x, y = np.meshgrid(np.arange(40) * 0.5 + 0.25, np.arange(40) * 0.5 + 0.25, indexing="ij")
    positions, radii = np.column_stack([x.ravel(), y.ravel()]), np.full(1600, 0.25)
    edge = np.flatnonzero(np.abs(positions[:, axis] - face) < 0.3)
    figure = plot_patterns({"first": (positions, radii, edge), "second": (positions, radii, edge)})
    assert len(figure.axes) == 2
    for panel in figure.axes:
        _, exposed = drawn(panel)
        assert set(exposed.get_offsets()[:, axis]) == {abs(face - 0.25)}
        low, high = (panel.get_xlim, panel.get_ylim)[axis]()
        # 16 diameters wide, the outermost radius of margin beyond the face
        assert high - low == pytest.approx(8.0)
        assert (high if side == "right" else low) == pytest.approx(face + (0.25 if side == "right" else -0.25))
        assert panel.get_title().endswith("40 boundary particles")

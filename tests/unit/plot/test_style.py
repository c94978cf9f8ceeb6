"""Figures are saved whole, alike, and in one style."""

import matplotlib
import pytest
from matplotlib import image

from dembound.plot.style import line_style, new_figure, point_style, save, styled


def test_a_saved_figure_is_a_png_of_its_size(tmp_path):
    save(new_figure(2.0, 1.0), tmp_path / "figure.png")
    assert image.imread(tmp_path / "figure.png").shape == (150, 300, 4)
    assert [path.name for path in tmp_path.iterdir()] == ["figure.png"]


def test_the_same_figure_saves_to_the_same_bytes(tmp_path):
    for name in ("first.png", "second.png"):
        save(new_figure(2.0, 1.0), tmp_path / name)
    assert (tmp_path / "first.png").read_bytes() == (tmp_path / "second.png").read_bytes()


def test_the_style_ends_with_the_drawing_and_does_not_depend_on_the_users():
    sizes = []

    @styled
    def draw():
        sizes.append(matplotlib.rcParams["lines.linewidth"])
        return new_figure(1.0, 1.0)

    with matplotlib.rc_context({"lines.linewidth": 9.0}):
        draw()
        assert matplotlib.rcParams["lines.linewidth"] == 9.0
    assert sizes == [1.4]


@pytest.mark.parametrize(("style", "count"), [(line_style, 28), (point_style, 35)])
def test_styles_tell_many_apart(style, count):
    assert len({tuple(style(index).values()) for index in range(count)}) == count

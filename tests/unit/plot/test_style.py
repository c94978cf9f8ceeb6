"""Figures are saved whole, alike, and in one style; tables hold their lines as they are drawn."""

import csv

import numpy as np
import pytest
from matplotlib import image

from dembound.plot.style import (
    Powers,
    decade,
    new_figure,
    outside_legend,
    save,
    time_unit,
)
from dembound.plot.table import columns_of, write_lines


def test_a_figure_is_saved_as_a_png_of_its_size_with_its_own_title_or_one_given(tmp_path):
    bytes_of = []
    for title in (None, None, "figure 1"):
        figure = new_figure(2.0, 1.0)
        figure.suptitle("what it shows")
        save(figure, tmp_path / "figure.png", title)
        assert figure.get_suptitle() == (title or "what it shows")
        assert image.imread(tmp_path / "figure.png").shape == (150, 300, 4)
        bytes_of.append((tmp_path / "figure.png").read_bytes())
    assert bytes_of[0] == bytes_of[1] != bytes_of[2]
    assert [path.name for path in tmp_path.iterdir()] == ["figure.png"]


def test_times_of_less_than_a_tenth_of_a_second_are_reported_in_milliseconds_and_decades_as_powers():
    assert [decade(value) for value in (1.0, 1e-3, 1e12)] == ["10⁰", "10⁻³", "10¹²"]
    assert [time_unit(last).label for last in (0.0, 0.0999, 0.1, 20.0)] == ["time (ms)"] * 2 + ["time (s)"] * 2
    assert [0.05 / time_unit(last).seconds for last in (0.05, 0.5)] == [50.0, 0.05]


@pytest.mark.parametrize(("largest", "power"), [(0.5, ""), (3e-5, "×10⁻⁵"), (2e12, "×10¹²")])
def test_a_common_power_of_ten_stands_at_the_end_of_an_axis(largest, power):
    figure = new_figure(3.0, 2.0)
    panel = figure.subplots()
    panel.set_ylim(-largest, largest)
    panel.yaxis.set_major_formatter(Powers())
    figure.draw_without_rendering()
    assert panel.yaxis.get_offset_text().get_text() == power
    assert max(float(label.get_text().replace("−", "-")) for label in panel.get_yticklabels()) < 10.0


def test_legends_have_what_is_seen_alone():
    figure = new_figure(4.0, 3.0)
    panel = figure.subplots()
    x = np.linspace(0.0, 1.0, 50)
    panel.plot(x, x, label="line")
    panel.plot(x + 5.0, x, label="line beyond the axes")
    panel.fill_between(x, x - 1e-4, x + 1e-4, label="band within the line")
    panel.fill_between(x, x - 0.1, x + 0.1, label="band")
    panel.scatter([0.5], [0.5], label="point")
    panel.scatter([9.0], [0.5], label="point beyond")
    panel.axhline(0.5, label="level")
    panel.axhline(7.0, label="level beyond")
    panel.plot([], [], label="key")
    panel.set(xlim=(0.0, 1.0), ylim=(-0.2, 1.2))
    outside_legend(figure, [panel], 3)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["line", "band", "point", "level", "key"]


@pytest.fixture
def figure():
    """Two panels on one axis: three named lines over two sets of places, and a frame."""
    figure = new_figure(4.0, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot([1.0, 2.0], [3.0, 4.0], gid="P1", label="one")
    upper.plot([1.0, 2.0, 3.0], [7.0, 8.0, 9.0], gid="P1", label="two")
    upper.axhline(5.0)
    lower.plot([1.0, 2.0], [5.0, 6.0], gid="P2", label="P2")
    upper.set_ylabel("force (N)")
    lower.set_ylabel("work (J)")
    lower.set_xlabel("time (s)")
    return figure


def test_lines_over_the_same_places_share_their_column(figure):
    columns = dict(columns_of(figure))
    places = ["time (s) of one", "time (s) of two"]
    assert list(columns) == [places[0], "P1, one: force (N)", "P2: work (J)", places[1], "P1, two: force (N)"]
    np.testing.assert_array_equal(columns["time (s) of one"], [1.0, 2.0])
    np.testing.assert_array_equal(columns["P2: work (J)"], [5.0, 6.0])


def test_shorter_columns_end_in_empty_cells_and_a_table_is_written_whole_or_not_at_all(figure, tmp_path):
    with pytest.raises(FileNotFoundError):
        write_lines(figure, tmp_path / "nowhere" / "table.csv")
    write_lines(figure, tmp_path / "table.csv")
    _, *rows = csv.reader((tmp_path / "table.csv").open(encoding="utf-8"))
    assert rows == [["1", "3", "5", "1", "7"], ["2", "4", "6", "2", "8"], ["", "", "", "3", "9"]]
    assert [path.name for path in tmp_path.iterdir()] == ["table.csv"]

"""Figures are saved whole, alike, and in one style; tables hold their lines as they are drawn."""

import csv

import numpy as np
import pytest
from matplotlib import image

from dembound.plot.style import decade, new_figure, save, time_unit
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

"""Estimated errors are a band around the line of a history, and a line without the error of the sides."""

import h5py
import numpy as np
import pytest

from dembound.plot.histories import plot_histories


@pytest.fixture
def estimated(small_run, tmp_path):
    """A run with an estimate for one of its monitors, up to the half of its time."""
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run) as record, h5py.File(tmp_path / "estimate.h5", "w") as file:
        group = record["histories/front"]
        half = len(group["time"]) // 2
        file["histories/front/time"] = group["time"][:half]
        file["histories/front/velocity/band"] = np.tile([0.25, 0.5], (half, 1))
        file["histories/front/velocity/corrected"] = group["velocity"][:half, :2] - [0.125, 0.0625]
    return run


@pytest.mark.parametrize(("component", "column", "wide", "less"), [("x", 0, 0.25, 0.125), ("y", 1, 0.5, 0.0625)])
def test_the_band_of_a_component_lies_around_its_line(estimated, component, column, wide, less):
    front, back = plot_histories([estimated], component).axes
    with h5py.File(estimated) as record:
        values = record["histories/front/velocity"][:, column]
    half = len(values) // 2
    (band,) = front.collections
    x, y = band.get_paths()[0].vertices.T
    assert x.max() == pytest.approx(front.lines[0].get_xdata()[half - 1])
    assert (y.min(), y.max()) == (pytest.approx(values[:half].min() - wide), pytest.approx(values[:half].max() + wide))
    np.testing.assert_allclose(front.lines[1].get_ydata(), values[:half] - less)
    assert len(back.collections) == 0
    assert len(back.lines) == 1


def test_quantities_without_an_estimate_have_no_band(estimated):
    assert all(not panel.collections for panel in plot_histories([estimated], quantity="displacement").axes)

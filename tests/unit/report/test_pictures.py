"""Pictures of a page have the pixels and the lines of their figures."""

import base64
import io

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from dembound.report.pictures import chart_of, thinned, uri_of


def pixels_in(uri):
    kind, _, data = uri.partition(",")
    assert kind == "data:image/webp;base64"
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))


def test_a_uri_holds_the_pixels():
    pixels = np.random.default_rng(5).integers(0, 256, (13, 17, 3), dtype=np.uint8)
    np.testing.assert_array_equal(pixels_in(uri_of(pixels, lossless=True)), pixels)
    smooth = np.linspace(0.0, 255.0, 64 * 64 * 3).reshape(64, 64, 3).astype(np.uint8)
    near = pixels_in(uri_of(smooth, lossless=False))
    assert np.abs(near.astype(int) - smooth).max() < 16  # less than is visible


@pytest.mark.parametrize(("count", "most"), [(10, 10), (1003, 100)])
def test_thinned_lines_keep_their_extremes_in_order(count, most):
    y = np.random.default_rng(count).normal(size=count)
    x = np.arange(count, dtype=float)
    few_x, few_y = thinned(x, y, most)
    assert len(few_x) <= most
    assert (np.diff(few_x) > 0).all()
    np.testing.assert_array_equal(few_y, y[few_x.astype(int)])
    assert {y.min(), y.max()} <= set(few_y)
    if count <= most:
        np.testing.assert_array_equal(few_x, x)


def figure_of_lines() -> Figure:
    figure = Figure()
    figure.suptitle("two panels\nof lines")
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot([0.0, 1.0, 2.0, 3.0], [1.0, np.nan, -4.0, 100.0], gid="a", label="run", color="#ff0000", linestyle="--")
    upper.plot([0.0, 1.0], [0.0, 0.0], label="without a name")
    upper.set(xlim=(0.0, 2.5), ylabel="height (m)", title="first")
    lower.plot([0.0, 1.0], [1.23456789, 1e-12], gid="b", alpha=0.4, linewidth=3.0)
    lower.set_xlabel("time (s)")
    return figure


def test_charts_have_named_lines_within_the_axes():
    chart = chart_of(figure_of_lines())
    assert (chart["title"], chart["x"], chart["sharedY"]) == ("two panels, of lines", "time (s)", False)
    upper, lower = chart["panels"]
    assert (upper["title"], upper["y"], upper["range"]) == ("first", "height (m)", [0.0, 2.5])
    looks = {"name": "run", "colour": "#ff0000", "dashed": True, "opacity": 1.0, "width": 1.5}
    assert upper["lines"] == [looks | {"x": [0.0, 1.0, 2.0], "y": [1.0, None, -4.0]}]
    (line,) = lower["lines"]
    assert (line["name"], line["dashed"], line["opacity"], line["width"]) == ("b", False, 0.4, 3.0)
    assert line["y"] == [1.23457, 1e-12]

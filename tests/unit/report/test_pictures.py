"""Pictures have the pixels and the lines of their figures, movies a frame for each snapshot, at their speed."""

import h5py
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from dembound.errors import CaseError
from dembound.plot.energy import plot_energy
from dembound.plot.side import plot_boundary, plot_side
from dembound.report.pictures import chart_of, movie_of, thinned, write_movie


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


def frames_in(path):
    """All frames (k, rows, columns, 3) of an animated picture, and the milliseconds that each is shown."""
    with Image.open(path) as picture:
        frames, times = [], []
        for number in range(picture.n_frames):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGB")))
            times.append(picture.info["duration"])
    return np.array(frames), times


def test_histories_alone_have_no_movie(pushed_runs, tmp_path):
    path = tmp_path / "run.h5"
    with h5py.File(pushed_runs[0]) as run, h5py.File(path, "w") as file:
        file.attrs.update(name="exact", size=run.attrs["size"])
        run.copy("histories", file)
    sides = (lambda run: plot_boundary([run], "left"), lambda run: plot_side([run], "left", "stress"))
    for draw in (movie_of, plot_energy, *sides):
        with pytest.raises(CaseError, match=r"run\.h5: has only histories, like those of `dembound exact` and"):
            draw(path)


@pytest.fixture(scope="module")
def pushed_movie(pushed_runs):
    """The movie of three snapshots, above the histories of two monitors."""
    return movie_of(pushed_runs[0], pixels=201)


def test_frames_are_those_of_the_snapshots_in_a_folder_without_loss(pushed_movie, tmp_path):
    drawn = []
    write_movie(pushed_movie, tmp_path / "movie.gif", 8.0, drawn.append)
    assert drawn == [1, 2, 3]
    frames, times = frames_in(tmp_path / "movie.gif")
    assert times == [130] * 3
    wholes = [pushed_movie.frame(number) for number in range(3)]
    for number, (frame, whole) in enumerate(zip(frames, wholes, strict=True)):
        assert whole.shape[0] % 2 == whole.shape[1] % 2 == 0
        # colours of a palette differ, but less than a frame from the next one
        errors = [np.abs(frame.astype(int) - other).mean() for other in wholes]
        assert np.argmin(errors) == number
        assert errors[number] < 8.0
    assert (frames[0][(wholes[0] == 255).all(axis=2)] == 255).all()

    folder = tmp_path / "frames"
    write_movie(pushed_movie, folder)
    assert sorted(path.name for path in folder.iterdir()) == [f"{number:04d}.png" for number in range(3)]
    for number, whole in enumerate(wholes):
        np.testing.assert_array_equal(np.asarray(Image.open(folder / f"{number:04d}.png")), whole)
    with pytest.raises(CaseError, match="frames is there already, frames are written to a new folder"):
        write_movie(pushed_movie, folder)

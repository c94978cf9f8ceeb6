"""Pictures have the pixels and the lines of their figures, movies a frame for each snapshot, at their speed."""

import base64
import errno
import io

import h5py
import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.figure import Figure
from PIL import Image

from dembound.errors import CaseError
from dembound.plot.energy import plot_energy
from dembound.plot.side import plot_boundary, plot_side
from dembound.plot.style import SIGNED_MAP
from dembound.report import pictures as movie_module
from dembound.report.pictures import chart_of, movie_of, thinned, uri_of, write_movie


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


def test_what_fails_in_between_leaves_nothing(pushed_movie, tmp_path):
    def full(drawn: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    for name in ("movie.gif", "frames"):
        with pytest.raises(OSError, match="No space left"):
            write_movie(pushed_movie, tmp_path / name, progress=full)
        assert not list(tmp_path.iterdir())


def test_a_gif_has_the_shades_of_the_colour_map(monkeypatch):
    """A wave in a mostly white picture, beside a bar of all its colours: no two levels of 20 look the same."""
    shades = colormaps[SIGNED_MAP](np.linspace(0.0, 1.0, 256), bytes=True)[:, :3]
    frame = np.full((600, 400, 3), 255, np.uint8)
    frame[:256, 350:370] = shades[:, None]
    frame[300:500, :256] = shades[64:192].repeat(2, axis=0)[None]
    frame[520:560, ::7] = np.random.default_rng(4).integers(0, 255, (40, 58, 1))

    class One:
        def __len__(self):
            return 1

        def frame(self, number):
            return frame

    made = np.asarray(movie_module._reduced(frame, movie_module._common_colours(One())).convert("RGB")).astype(int)
    errors = np.abs(made - frame)[:500].max(axis=2)
    # 96 shades are 2.7 of 255 steps of the map apart, of which one changes a colour by up to 6: half of 16, rounded
    assert errors.max() <= 9
    assert len(np.unique(made[:256, 360], axis=0)) >= 96


def test_what_cannot_be_shown_is_said(blind_run, pushed_runs, pushed_movie, tmp_path):
    with pytest.raises(CaseError, match="has no snapshots"):
        movie_of(blind_run)
    with pytest.raises(CaseError, match="field: is damage"):
        movie_of(pushed_runs[0], field="damage")
    with pytest.raises(CaseError, match=r"--output: is .*movie\.avi, must end in \.gif, or have no ending"):
        write_movie(pushed_movie, tmp_path / "movie.avi")

"""Movies have a frame for each snapshot, at their speed, in every format."""

import shutil
import subprocess

import h5py
import numpy as np
import pytest
from matplotlib import colormaps
from PIL import Image
from readable import problems_of

from dembound.errors import CaseError, DemboundError
from dembound.plot.boundary import plot_boundary
from dembound.plot.energy import plot_energy
from dembound.plot.side import plot_side
from dembound.plot.style import SIGNED_MAP
from dembound.report import movie as movie_module
from dembound.report.movie import movie_of, write_movie


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
        with pytest.raises(CaseError, match=r"run\.h5: has histories alone, as those of `dembound exact` and"):
            draw(path)


@pytest.mark.parametrize(("ending", "fps", "shown"), [("gif", 8.0, 130), ("gif", 80.0, 20), ("webp", 8.0, 125)])
def test_frames_are_those_of_the_snapshots(pushed_runs, tmp_path, ending, fps, shown):
    movie, drawn = movie_of(pushed_runs[0], pixels=201), []
    write_movie(movie, tmp_path / f"movie.{ending}", fps, drawn.append)
    assert drawn == [1, 2, 3]
    frames, times = frames_in(tmp_path / f"movie.{ending}")
    assert times == [shown] * 3
    for number, frame in enumerate(frames):
        whole = movie.frame(number)
        assert whole.shape == frame.shape
        assert whole.shape[0] % 2 == whole.shape[1] % 2 == 0
        # colours of a palette and of WebP differ, but less than a frame from the next one
        errors = [np.abs(frame.astype(int) - movie.frame(other)).mean() for other in range(3)]
        assert np.argmin(errors) == number
        assert errors[number] < 8.0
    white = frames[0][(movie.frame(0) == 255).all(axis=2)]
    assert (white == 255).all() if ending == "gif" else white.mean() > 253.0


def test_a_movie_with_ffmpeg(pushed_runs, tmp_path):
    if shutil.which("ffmpeg") is None or shutil.which("ffprobe") is None:
        pytest.skip("ffmpeg is not on the path")
    movie = movie_of(pushed_runs[0], pixels=301)
    write_movie(movie, tmp_path / "movie.mp4", 5.0)
    asked = ["-show_entries", "stream=width,height,nb_frames,r_frame_rate", "-of", "csv=p=0"]
    told = subprocess.run(
        ["ffprobe", "-v", "error", *asked, str(tmp_path / "movie.mp4")], capture_output=True, text=True, check=True
    )
    rows, columns, _ = movie.frame(0).shape
    assert told.stdout.strip() == f"{columns},{rows},5/1,3"


def test_failures_of_ffmpeg_are_one_line_and_leave_nothing(pushed_runs, tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho first >&2\necho no encoder here >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    with pytest.raises(DemboundError, match=r"^ffmpeg: no encoder here$"):
        write_movie(movie_of(pushed_runs[0]), tmp_path / "movie.mp4")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ffmpeg"]
    program.unlink()
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(CaseError, match=r"\.mp4 needs the program ffmpeg, which is not found"):
        write_movie(movie_of(pushed_runs[0]), tmp_path / "movie.mp4")


@pytest.mark.parametrize(("every", "chosen"), [(1, list(range(12))), (5, [0, 5, 10, 11]), (11, [0, 11]), (50, [0, 11])])
def test_every_so_many_snapshots_and_the_last(spalled_results, every, chosen):
    assert movie_of(spalled_results, every=every).chosen == chosen


def test_histories_are_below_and_the_line_moves(pushed_runs, spalled_results):
    alone, both = movie_of(pushed_runs[0], monitors=[], pixels=300), movie_of(pushed_runs[0], pixels=300)
    assert alone.below is None
    rows = alone.frame(0).shape[0]
    top = rows - rows % 2
    np.testing.assert_array_equal(alone.frame(1)[: top - 1], both.frame(1)[: top - 1])
    assert [panel.get_title("left").split(" at ")[0] for panel in both.below.figure.axes] == ["front", "back"]
    assert (both.frame(0)[rows + 1 :] != both.frame(1)[rows + 1 :]).any()
    assert movie_of(spalled_results, monitors=["gauge"]).below is not None
    with pytest.raises(CaseError, match="monitor: is nobody, must be one of"):
        movie_of(pushed_runs[0], monitors=["nobody"])


def test_all_of_many_monitors_are_shown_with_three_numbers_each(many_monitors):
    figure = movie_of(many_monitors).below.figure
    assert [panel.get_title("left").split(" at ")[0] for panel in figure.axes] == [f"M{n}" for n in range(9)]
    assert problems_of(figure) == []


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


def test_what_cannot_be_shown_is_said(blind_run, pushed_runs, tmp_path):
    with pytest.raises(CaseError, match="has no snapshots"):
        movie_of(blind_run)
    with pytest.raises(CaseError, match="field: is damage"):
        movie_of(pushed_runs[0], field="damage")
    with pytest.raises(CaseError, match=r"--output: is .*movie\.avi, must end in one of \.gif, \.webp, \.mp4"):
        write_movie(movie_of(pushed_runs[0]), tmp_path / "movie.avi")

"""Waves from files: what is read, and what is refused."""

import re
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

from dembound.waves import FileWave
from dembound.waves.file_wave import read_text, samples_of


def record(folder: Path, text: str, **keys: float | str) -> FileWave:
    (folder / "quake.txt").write_text(text, encoding="utf-8")
    table = {"type": "file", "path": "quake.txt", **keys}
    return TypeAdapter(FileWave).validate_python(table, context={"folder": folder})


def samples(path: Path, **quantity: str) -> np.ndarray:
    """The two columns of a file, as waves and records read it."""
    return samples_of(read_text(path), path, **quantity)


TRIANGLE = "# a triangle\n0.0 0.0\n1.0 2.0  # crest\n\n3.0 0.0\n"


def test_lines_join_the_samples_and_rest_is_outside(tmp_path: Path) -> None:
    wave = record(tmp_path, TRIANGLE, start=10.0, scale=-0.5)

    assert wave.velocity(np.array([9.9, 10.5, 11.0, 12.0, 13.1])).tolist() == [0.0, -0.5, -1.0, -0.5, 0.0]
    assert (wave.peak(), wave.peak_time(), wave.duration()) == (1.0, 11.0, 13.0)


def test_displacement_is_exact_between_and_beyond_samples(tmp_path: Path) -> None:
    wave = record(tmp_path, TRIANGLE)
    t = np.array([-1.0, 0.5, 1.0, 2.0, 3.0, 50.0])

    # areas under the triangle: t² on the rise; 3 − (3 − t)²/2 on the fall
    assert wave.displacement(t).tolist() == [0.0, 0.25, 1.0, 2.5, 3.0, 3.0]
    late = record(tmp_path, "1.0 2.0\n2.0 2.0\n2.5 2.0\n")  # and away from zero
    assert late.velocity(np.array([0.999, 1.0, 2.5, 2.501])).tolist() == [0.0, 2.0, 2.0, 0.0]
    assert late.displacement(np.array([0.5, 1.5, 2.25, 9.0])).tolist() == [0.0, 1.0, 2.5, 3.0]
    assert wave == record(tmp_path, TRIANGLE) != late
    outcrop = record(tmp_path, TRIANGLE, motion="outcrop")  # moves twice as fast as the wave that enters
    assert outcrop.displacement(t).tolist() == [0.0, 0.125, 0.5, 1.25, 1.5, 1.5]


def test_frequencies_of_a_sampled_pulse(tmp_path: Path) -> None:
    t = np.arange(0.0, 0.5005, 0.001)
    pulse = 0.5 * (1.0 - np.cos(4.0 * np.pi * t))
    wave = record(tmp_path, "\n".join(f"{a!r} {b!r}" for a, b in zip(t.tolist(), pulse.tolist(), strict=True)))

    # bins are 1/(8 · 0.5 s) = 0.25 Hz. f·|V| of the Hann lobe, sin(πx)/(1 − x²), is largest at x = 0.837;
    # |V| itself, sin(πx)/[πx(1 − x²)], falls below 1 % for good at x = 2.797, and the next bin is given
    assert wave.dominant_frequency() == pytest.approx(0.837 / 0.5, abs=0.25)
    assert 2.79 / 0.5 <= wave.highest_frequency() <= 2.80 / 0.5 + 0.25


def test_frequencies_do_not_suffer_from_a_long_line(tmp_path: Path) -> None:
    frequency, step = 25.0, 0.002
    t = np.append(step * np.arange(61), 1.0)
    a = np.square(np.pi * (frequency * t - 1.5))
    ricker = (1.0 - 2.0 * a) * np.exp(-a)
    wave = record(tmp_path, "\n".join(f"{a!r} {b!r}" for a, b in zip(t.tolist(), ricker.tolist(), strict=True)))

    # of Ricker's wavelet |V| ~ x² exp(1 − x²), x = F/f, falls below 1 % at 2.764, and f·|V| is largest at x² = 3/2.
    # Bins are 1/8 Hz, and of |V| 1e-8 is lost at either end; the step is given by most samples, not by the last
    assert wave.dominant_frequency() == pytest.approx(np.sqrt(1.5) * frequency, abs=0.125)
    assert wave.highest_frequency() == pytest.approx(2.764 * frequency, abs=0.125)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("gauge.csv", "Time (s),Stress 1 (Pa)\n0,0.5\n1, -2\n"),
        ("gauge.csv", "\ufefft;s\n0;0.5\n1;-2\n"),
        ("gauge.csv", "0;0,5\n1,0;-2\n"),
        ("gauge.txt", "# a gauge; in Pa\nt; s\n0; 0.5  # first\n1; -2\n"),
        ("gauge.txt", "\ufefftime stress\n0 0.5\n1\t-2\n"),
    ],
)
def test_headers_marks_of_spreadsheets_and_semicolons_are_read(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8", newline="")

    assert samples(tmp_path / name).tolist() == [[0.0, 0.5], [1.0, -2.0]]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("0 0 0\n1 1 1\n", r"has 3 columns, must have two: time \(s\), values; .* `dembound wave` makes"),
        ("0 0\n1 1 1\n", "is not two columns of numbers"),
        ("time 0\n0 0\n1 1\n", "is not two columns of numbers"),
        ("0,0\n1,1\n", "is not two columns of numbers"),
        ("0 0\n1 nan\n", "not finite"),
        ("0 1\n", "at least two"),
        ("0 0\n1 1\n1 2\n", "row 3"),
        ("0 0\n1 0\n", "only zeros"),
    ],
)
def test_bad_files_are_refused_with_their_name(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "bad.txt"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(ValueError, match=reason) as caught:
        samples(path)
    assert str(caught.value).startswith(f'path: "{path}" ')


def test_absent_or_binary_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no file"):
        samples(tmp_path / "absent.txt")
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(ValueError, match=r"is not two columns of numbers"):
        samples(tmp_path / "binary", quantity="stress (Pa)")


STEP, COUNT = 0.01, 401


def written(times: np.ndarray, values: np.ndarray) -> str:
    """The text of a file."""
    return "\n".join(f"{a!r} {b!r}" for a, b in zip(times.tolist(), values.tolist(), strict=True))


def burst(share: float, times: np.ndarray, count: int = COUNT) -> np.ndarray:
    """A sine of a share of the sampling rate under sin⁴, whose spectrum has faded 3 Hz away, so band-limited."""
    length = STEP * (count - 1)
    inside = np.sin(np.pi * np.clip(times / length, 0.0, 1.0)) ** 4
    return inside * np.sin(2.0 * np.pi * share / STEP * times + 0.3)


def burst_file(share: float = 0.2, count: int = COUNT) -> str:
    times = STEP * np.arange(count)
    return written(times, burst(share, times, count))


@pytest.mark.parametrize("share", [0.1, 0.4])
def test_a_record_keeps_frequencies_up_to_almost_half_its_rate(tmp_path: Path, share: float) -> None:
    wave = record(tmp_path, burst_file(share), start=2.0, scale=-3.0)
    length = STEP * (COUNT - 1)
    fine = np.linspace(0.0, length, 128 * (COUNT - 1) + 1)
    exact = -3.0 * burst(share, fine)

    # straight lines between points h apart miss (ωh)²/8 at most and keep sinc²(fh) of a sine, h = a sixteenth of the
    # step; the rest of the burst's spectrum is 1e-5
    omega = 2.0 * np.pi * share / 16.0
    assert np.abs(wave.velocity(2.0 + fine) - exact).max() < 3.0 * (omega**2 / 8.0 + 2e-5)
    turned = np.exp(-2j * np.pi * share / STEP * fine) * burst(share, fine) ** 2
    kept = abs(turned @ wave.velocity(2.0 + fine)) / abs(turned @ exact)
    assert kept == pytest.approx(np.sinc(share / 16.0) ** 2, abs=1e-4)
    assert kept > 0.995
    # its integral is that of the velocity itself, exact for straight lines between the points
    h = fine[1] - fine[0]
    velocity = wave.velocity(2.0 + fine)
    summed = np.append(0.0, np.cumsum(0.5 * h * (velocity[1:] + velocity[:-1])))
    np.testing.assert_allclose(wave.displacement(2.0 + fine), summed, atol=1e-13)
    assert wave.peak() == pytest.approx(np.abs(exact).max(), rel=omega**2 / 2.0)
    assert abs(wave.velocity(np.array([wave.peak_time()]))[0]) == pytest.approx(wave.peak(), rel=1e-12)
    assert wave.joined_by == "band_limited"
    assert (wave.begin(), wave.duration()) == (2.0, 2.0 + length)
    assert wave.velocity(np.array([1.999, 2.0 + length + 1e-6])).tolist() == [0.0, 0.0]
    assert wave == record(tmp_path, burst_file(share), start=2.0, scale=-3.0)
    assert wave != record(tmp_path, burst_file(share), start=2.0, scale=3.0)


def test_what_is_cut_before_a_record_is_tiny(tmp_path: Path) -> None:
    """Zeros before it stay zeros: a sum of sincs over a tapered record rings there by less than 1e-3 of its peak."""
    rng, lead = np.random.default_rng(2), 60
    spectrum = np.fft.rfft(rng.standard_normal(400)) * (np.fft.rfftfreq(400) < 0.4)
    values = np.fft.irfft(spectrum) * np.sin(np.pi * np.arange(400) / 399) ** 2
    values[[0, -1]] = 0.0
    padded = np.concatenate([np.zeros(lead), values, np.zeros(lead)])
    wave = record(tmp_path, written(STEP * np.arange(len(padded)), padded))
    outside = np.concatenate([np.linspace(-lead, 0.0, 1000), 399 + np.linspace(0.0, lead, 1000)])
    rung = np.sinc(outside[:, None] - np.arange(400)) @ values

    assert np.abs(rung).max() < 1e-3 * wave.peak()
    assert not wave.velocity(STEP * (lead + outside)).any()
    inside = np.linspace(0.0, 399.0, 16 * 399 + 1)
    exact = np.sinc(inside[:, None] - np.arange(400)) @ values  # and points lie on it
    np.testing.assert_allclose(wave.velocity(STEP * (lead + inside)), exact, atol=1e-5 * wave.peak())
    alone = record(tmp_path, written(STEP * np.arange(400), values))
    np.testing.assert_allclose(alone.velocity(STEP * inside), exact, atol=1e-5 * wave.peak())


ROWS = STEP * np.arange(COUNT)
PULSE = np.sin(np.pi * ROWS / ROWS[-1]) ** 2


@pytest.mark.parametrize(
    ("times", "values", "joined"),
    [
        (ROWS, burst(0.2, ROWS), "band"),
        (np.delete(ROWS, 200), np.delete(burst(0.2, ROWS), 200), "lines"),  # a lost sample
        (ROWS, PULSE, "lines"),  # one-sided
        (ROWS, burst(0.2, ROWS) + 0.03, "lines"),  # begins with 3 % of its peak
        (ROWS[:19], burst(0.2, ROWS[:19], 19), "lines"),  # few
    ],
)
def test_what_joins_samples_follows_from_them(tmp_path: Path, times, values, joined: str) -> None:
    wave = record(tmp_path, written(times, values))
    between = np.linspace(times[0], times[-1], 1000)
    lines = np.array_equal(wave.velocity(between), np.interp(between, times, values))

    assert lines == (joined == "lines") == (wave.joined_by == "lines")
    assert wave.joined().endswith("straight lines" if lines else "the band-limited function")
    assert wave.describe()["interpolation"] == wave.joined_by
    assert record(tmp_path, written(times, values), interpolation="lines").joined_by == "lines"
    if not lines:
        assert np.abs(wave.velocity(between) - np.interp(between, times, values)).max() > 0.1


def test_uneven_samples_have_no_band_limit(tmp_path: Path) -> None:
    with pytest.raises(
        ValueError, match=r'interpolation: is "band_limited", which needs even times; steps in .* 1 to 2 s'
    ):
        record(tmp_path, TRIANGLE, interpolation="band_limited")


def test_a_function_far_beyond_its_samples_and_lines_that_lose_much_are_warned_of(tmp_path: Path) -> None:
    square = np.where(np.sin(2.0 * np.pi * ROWS) > 0.0, 1.0, -1.0)
    square[[0, -1]] = 0.0
    for text, keys, words in (
        (written(ROWS, square), {}, r'exceeds its largest sample by .* give interpolation = "lines"'),
        (written(ROWS, square), {"interpolation": "lines"}, None),
        (burst_file(0.3), {}, None),
        (burst_file(0.3), {"interpolation": "lines"}, 'straight lines between them take .* "band_limited"'),
    ):
        found = list(record(tmp_path, text, **keys).doubts("m/s", 1.0))
        assert len(found) == (words is not None), found
        assert words is None or re.search(words, found[0])

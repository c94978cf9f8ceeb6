"""Waves from files: what is read, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

from dembound.waves import FileWave
from dembound.waves.file_wave import read_text, samples_of


def record(folder: Path, text: str, **keys: float) -> FileWave:
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
        ("gauge.csv", "# time,stress\n0,0.5\n1, -2\n"),
        ("gauge.csv", "Time (s),Stress 1 (Pa)\n0,0.5\n1, -2\n"),
        ("gauge.csv", "\ufefft;s\n0;0.5\n1;-2\n"),
        ("gauge.csv", "0;0,5\n1,0;-2\n"),
        ("gauge.txt", "# a gauge; in Pa\nt; s\n0; 0.5  # first\n1; -2\n"),
        ("gauge.txt", "\ufefftime stress\n0 0.5\n1\t-2\n"),
        ("gauge.txt", "\ufeff0 0.5\r\n1 -2\r\n"),
    ],
)
def test_headers_marks_of_spreadsheets_and_semicolons_are_read(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8", newline="")

    assert samples(tmp_path / name).tolist() == [[0.0, 0.5], [1.0, -2.0]]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("# only words\n", "contains no numbers"),
        ("0 0 0\n1 1 1\n", r"has 3 columns, must have two: time \(s\), values$"),
        ("0\n1\n", "has 1 columns"),
        ("0 0\n1 1 1\n", "is not two columns of numbers"),
        ("time velocity\ns m/s\n0 0\n1 1\n", "is not two columns of numbers"),
        ("time 0\n0 0\n1 1\n", "is not two columns of numbers"),
        ("0,0;1.000,5\n1;1\n", "is not two columns of numbers"),
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

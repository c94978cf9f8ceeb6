"""A measured or computed velocity history, read from a text file."""

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from pydantic import PrivateAttr, ValidationInfo, model_validator

from dembound.spectra import band_limited
from dembound.table import LARGEST, SMALLEST, quantity
from dembound.waves.record_doubts import FEWEST, doubts_of_header, doubts_of_samples, is_even, is_record, usual_step
from dembound.waves.wave import NonZero, Polyline, Wave, amplitude_spectrum, faded_frequency
from dembound.words import percent, with_unit

NO_COLUMNS = "is not two columns of numbers, separated by blanks or semicolons, in a .csv file by commas"

OF_A_RECORD = "if it is a measured record: `dembound wave` makes a wave of it"

MOST_SAMPLES = 2**20
"""Largest number of even samples for a spectrum; very uneven times could need far more."""

FINER = 16
"""Points in place of each sample of a record, joined by straight lines: these keep sinc²(f Δt/16), 99.8 % of the
amplitude at 0.4 of the sampling rate."""

OVERSHOOT = 0.1
"""Part of the largest sample by which the band-limited function exceeds it beside a jump: 0.09 of its height."""

JOINED = {"band_limited": "the band-limited function", "lines": "straight lines"}
"""How samples are joined -> in words."""

JUMP = 4.0
"""Spacing of two samples, in units of the last place, up to which they are a jump."""


class FileWave(Wave):
    """Velocities from a file, between its samples as `interpolation` says, zero outside; times count from `start`.

    Columns are separated by blanks, in a .csv file by commas, or by semicolons, with which numbers may have decimal
    commas. A header line and text after # are skipped; a header with other units than s and m/s, or Pa, N or m/s² of a
    load, is warned of.

    Notes
    -----
    The band-limited function is taken at 16 points for each sample, joined by straight lines. Zeros at the beginning
    and end of a file stay zeros: there the function, which rings a little before a record begins, is cut.

    Validation passes the case file's folder as the context ``{"folder": Path}``; without one relative paths are taken
    from the current folder. Texts by path that are passed as "files" replace files.
    """

    halves: ClassVar[bool] = True

    type: Literal["file"]
    path: str = quantity(min_length=1)
    """text file of time (s) and velocity (m/s) or the factor of a load, in columns by blanks or semicolons, in a .csv
    file commas"""
    scale: NonZero = quantity(1.0, means="factor")
    """factor of the file's values"""

    interpolation: Literal["band_limited", "lines"] | None = quantity(None)
    """"lines", or the "band_limited" function, up to 0.4 of the sampling rate; absent: band_limited for a record (20
    even samples, 6 changes of sign, ends within 2 % of the peak)"""

    _samples: Polyline = PrivateAttr()
    _line: Polyline = PrivateAttr()
    _text: str = PrivateAttr(default="")

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> "FileWave":
        context = info.context or {}
        path = context.get("folder", Path()) / self.path
        given = context.get("files", {}).get(self.path)
        self._text = read_text(path) if given is None else given
        samples = samples_of(self._text, path)
        shortest = _shortest(samples[:, 0])
        self._require_resolved(float(np.abs(samples[:, 0]).max()), shortest, f'path: a time in "{path}"')
        self._require_resolved(self.start, shortest, "start:")
        self._samples = Polyline(self.start + samples[:, 0], self.share * self.scale * samples[:, 1])
        if self.interpolation == "band_limited" and not is_even(samples[:, 0]):
            least, most = np.diff(samples[:, 0]).min(), np.diff(samples[:, 0]).max()
            raise ValueError(
                f'interpolation: is "band_limited", which needs even times; steps in "{path}" are {least:.4g} to '
                f'{most:.4g} s; give "lines", or resample the record'
            )
        self._line = self._samples if self.joined_by == "lines" else _finer(self._samples)
        return self

    @property
    def samples(self) -> Polyline:
        """The samples of the file, scaled, at times counted from t = 0."""
        return self._samples

    @property
    def line(self) -> Polyline:
        """The points whose straight lines are the velocity: the samples, or `FINER` times as many."""
        return self._line

    @property
    def joined_by(self) -> Literal["band_limited", "lines"]:
        """What joins the samples: `interpolation`, or what suits them if it is not given."""
        if self.interpolation is not None:
            return self.interpolation
        return "band_limited" if is_record(self._samples.times, self._samples.values) else "lines"

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""
        return self._line.at(t)

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Exact time integral of the velocity from −∞ to t, m; same shape as t."""
        return self._line.integral(t)

    def peak(self) -> float:
        """Largest |velocity|, between the samples too, scaled, m/s."""
        return float(np.abs(self._line.values).max())

    def peak_time(self) -> float:
        """Time of the first largest |velocity|, s."""
        return float(self._line.times[np.abs(self._line.values).argmax()])

    def begin(self) -> float:
        """Time of the first line, s."""
        return float(self._samples.times[0])

    def duration(self) -> float:
        """Time from which the wave is over, s: the time of the last line."""
        return float(self._samples.times[-1])

    def ends(self) -> tuple[tuple[str, float, float], ...]:
        """First and last velocities of the record, beyond which it is zero, with their times."""
        times, velocities = self._samples.times, self._samples.values
        return ("begins", float(times[0]), float(velocities[0])), ("ends", float(times[-1]), float(velocities[-1]))

    def doubts(self, read: str, factor: float) -> Iterator[str]:
        """Signs of wrong units, lost samples and the like in the header of the file and its samples."""
        times, velocities = self._samples.times, self._samples.values
        yield from doubts_of_header(header_of(self._text), read, self.scale * factor)
        yield from doubts_of_samples(times, velocities, by_lines=self.joined_by == "lines")
        above = self.peak() / float(np.abs(velocities).max()) - 1.0
        if above > OVERSHOOT:
            yield (
                f"exceeds its largest sample by {percent(above)} at {self.peak_time():.4g} s, between samples; if they "
                'jump there, give interpolation = "lines"'
            )

    def joined(self) -> str:
        """The sampling rate, or the number of points, and what joins them, in words."""
        times = self._samples.times
        sampled = f"sampled at {with_unit(1.0 / usual_step(times), 'Hz')}"
        return f"{sampled if len(times) >= FEWEST else f'{len(times)} points'}, joined by {JOINED[self.joined_by]}"

    def describe(self) -> dict[str, str | float]:
        """What joins the samples, and their number per second."""
        return {"interpolation": self.joined_by, "sampling_rate": 1.0 / usual_step(self._samples.times)}

    def time_scale(self) -> float:
        """Length of the record, s, although single samples may vary much faster."""
        return self.duration() - self.start

    def moved(self, here: Path, there: Path) -> dict[str, str]:
        """The new relative path of the file."""
        if Path(self.path).is_absolute() or here == there:
            return {}
        return {"path": Path(os.path.relpath(here / self.path, there)).as_posix()}

    def files(self) -> dict[str, str]:
        """The text of the file."""
        return {self.path: self._text}

    def dominant_frequency(self) -> float:
        """Frequency at which the *acceleration's* amplitude spectrum is largest, Hz.

        A record with net displacement has its largest velocity amplitude at zero frequency.
        """
        frequencies, amplitudes = self._spectrum()
        return float(frequencies[np.argmax(frequencies * amplitudes)])

    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz.

        At most the Nyquist frequency of the file's usual time step.
        """
        return faded_frequency(*self._spectrum())

    def _spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        times = self._samples.times
        usual, length = usual_step(times), float(times[-1] - times[0])
        time_step = max(usual, length / MOST_SAMPLES)
        evenly = np.arange(times[0], times[-1] + time_step, time_step)
        return amplitude_spectrum(self.velocity(evenly), time_step)


def _finer(samples: Polyline) -> Polyline:
    """The band-limited function through even samples, `FINER` times as often; zeros at both ends stay zeros."""
    values = band_limited(samples.values, FINER)
    moves = np.flatnonzero(samples.values)
    values[: FINER * max(moves[0] - 1, 0)] = 0.0
    values[FINER * (moves[-1] + 1) :] = 0.0
    return Polyline(np.linspace(samples.times[0], samples.times[-1], len(values)), values)


def read_text(path: Path) -> str:
    """The text of a file, without the byte order mark of spreadsheets.

    Raises ValueError if the file is absent or no text, with a message that starts with ``path:``.
    """
    try:
        if not path.is_file():
            raise ValueError(f'path: "{path}" is not a regular file' if path.exists() else f'path: no file "{path}"')
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f'path: "{path}" {NO_COLUMNS}: it is not text in UTF-8') from None
    except OSError as error:
        raise ValueError(f'path: "{path}" cannot be read: {error.strerror}') from None


def samples_of(text: str, path: Path, quantity: str = "values") -> np.ndarray:
    """The two columns of the text of a file as an array (k, 2): times, s, and values of a quantity (for error texts).

    Columns are separated by semicolons, where numbers may have decimal commas; in a file called ``.csv`` by commas; or
    else by blanks. A ``#`` begins a comment, and a first line without numbers is a header.

    Raises
    ------
    ValueError
        If it does not contain a history; the message starts with ``path:``.
    """
    samples = columns_in(text, path, f"; {OF_A_RECORD}")
    problem = _problem(samples, quantity)
    if problem:
        raise ValueError(f'path: "{path}" {problem}')
    return samples


def columns_in(text: str, path: Path, advice: str = "") -> np.ndarray:
    """The columns (k, c) of numbers of the text of a file, see `samples_of`; advice : at the end of messages.

    Raises ValueError for a text without columns of numbers; the message starts with ``path:``.
    """
    lines, separator = _numbers(text, path.suffix.lower() == ".csv")
    try:
        plain = [line for _, line in lines]
        return np.loadtxt(plain, ndmin=2, delimiter=separator) if plain else np.empty((0, 2))
    except ValueError:  # which quotes the file: it may be any file
        raise ValueError(f'path: "{path}" {NO_COLUMNS}: {_misfit(lines, separator)}{advice}') from None


def _numbers(text: str, is_csv: bool) -> tuple[list[tuple[int, str]], str | None]:
    """The lines with numbers of a text with their line numbers, with decimal points, and the separator of columns.

    The separator None stands for blanks.
    """
    lines = [(number, line.partition("#")[0]) for number, line in enumerate(text.splitlines(), start=1)]
    lines = [(number, line) for number, line in lines if line.strip()]
    separator = "," if is_csv else None
    if lines and ";" in lines[-1][1]:
        lines, separator = [(number, line.replace(",", ".")) for number, line in lines], ";"
    has_header = bool(lines) and not any(_is_number(field) for field in lines[0][1].split(separator))
    return lines[has_header:], separator


def header_of(text: str) -> str:
    """The lines with words above the numbers of a file, comments with numbers in them included."""
    above = []
    for line in text.splitlines():
        if any(_is_number(field) for field in re.split(r"[\s,;]+", line.partition("#")[0].strip())):
            break
        above.append(line.strip("# \t"))
    return "\n".join(filter(None, above))


def _misfit(lines: Sequence[tuple[int, str]], separator: str | None) -> str:
    """Number of the first line that differs from the first one or has no numbers, in words; its text is not quoted."""
    columns = len(lines[0][1].split(separator))
    for number, line in lines:
        fields = line.split(separator)
        if len(fields) != columns:
            return f"line {number} has {len(fields)} of them, the first one has {columns}"
        if not all(map(_is_number, fields)):
            return f"line {number} has a text that is no number"
    return "it has a number of unusual form"


def _is_number(text: str) -> bool:
    """Whether a text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _problem(samples: np.ndarray, quantity: str) -> str:
    """Message why samples (k, c) are not a history of a quantity; empty if they are."""
    if samples.size == 0:
        return "contains no numbers"
    if samples.shape[1] != 2:
        return f"has {samples.shape[1]} columns, must have two: time (s), {quantity}; {OF_A_RECORD}"
    if not np.isfinite(samples).all():
        return "contains values that are not finite"
    if np.abs(samples).max() > LARGEST:
        return f"contains values beyond {LARGEST:g}"
    if len(samples) < 2:
        return "contains one line, must contain at least two"
    steps = np.diff(samples[:, 0])
    if not (steps > SMALLEST).all():
        line = int(np.argmin(steps > SMALLEST)) + 2
        return f"must have increasing times; row {line} of its numbers does not follow the row before"
    if not samples[:, 1].any():
        return "contains only zeros"
    return ""


def _shortest(times: np.ndarray) -> float:
    """The shortest time (s) between two samples that is not a jump."""
    steps = np.diff(times)
    resolved = steps[steps > JUMP * np.spacing(np.abs(times[1:]))]
    return float(resolved.min() if resolved.size > 0 else steps.min())

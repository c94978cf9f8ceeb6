"""Filters that shift no phase: forwards and backwards, so that a wave stays where it is in time."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.errors import CaseError

ORDER = 4
"""Order of the Butterworth filters in one direction; both directions together have 6 dB at the corner."""

QUALITY = 10.0
"""Frequency of a notch over its width at 3 dB."""

PERIODS = 3.0
"""Least number of periods of every filter frequency in a record."""


@dataclass(frozen=True)
class Filters:
    """Corners in Hz of the filters of a signal; None and empty for none.

    low_pass, high_pass : of the lower and the upper range that remains. notches : frequencies that are taken out.
    order : of the Butterworth filters in one direction.
    """

    low_pass: float | None = None
    high_pass: float | None = None
    notches: tuple[float, ...] = ()
    order: int = ORDER

    def apply(self, time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, list[str]]:
        """The filtered signal (k,) at even times (k,) s, and what was done.

        Raises CaseError for corners above the Nyquist frequency or of waves too long for the record.
        """
        from scipy.signal import butter, iirnotch, sosfiltfilt, tf2sos

        rate = (len(time) - 1) / float(time[-1] - time[0])
        self.require(rate, len(time))
        notes = []
        for corner, kind in ((self.high_pass, "highpass"), (self.low_pass, "lowpass")):
            if corner is not None:
                values = _padded(
                    sosfiltfilt, butter(self.order, corner, kind, fs=rate, output="sos"), values, rate / corner
                )
                words = f"{kind.removesuffix('pass')} pass at {corner:g} Hz (6 dB)"
                notes.append(f"filter: {words}, Butterworth of order {self.order} forwards and backwards")
        for notch in self.notches:
            sections = tf2sos(*iirnotch(notch, QUALITY, fs=rate))
            values = _padded(sosfiltfilt, sections, values, QUALITY * rate / notch)
            notes.append(f"filter: notch at {notch:g} Hz, {notch / QUALITY:g} Hz wide, forwards and backwards")
        return values, notes

    def require(self, rate: float, count: int) -> None:
        """Raise CaseError for corners that a record of so many samples does not have; rate : of them, Hz."""
        if problems := list(self._problems(rate, count)):
            raise CaseError(problems)

    def _problems(self, rate: float, count: int) -> Iterator[str]:
        """Corners that are impossible in this record."""
        corners = [("--low-pass", self.low_pass), ("--high-pass", self.high_pass)]
        corners += [("--notch", notch) for notch in self.notches]
        for option, corner in corners:
            if corner is not None and not PERIODS * rate / count <= corner < 0.5 * rate:
                least, most = PERIODS * rate / count, 0.5 * rate
                yield f"{option}: is {corner:g} Hz, must be from {least:.3g} to below {most:.3g} Hz in this record"
        low, high = self.low_pass, self.high_pass
        if low is not None and high is not None and not high < low:
            yield f"--high-pass: is {high:g} Hz, must be below the low pass, {low:g} Hz"


def _padded(filtfilt, sections: np.ndarray, values: np.ndarray, length: float) -> np.ndarray:  # type: ignore[no-untyped-def]
    """A signal filtered both ways, continued at its ends by its mirror images over the length of the response."""
    return filtfilt(sections, values, padlen=min(len(values) - 1, int(3.0 * length)))

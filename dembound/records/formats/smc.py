"""SMC files of the U.S. Geological Survey: one component.

Eleven lines of text, 48 integers, 50 numbers, comments that begin with "|", and values without blanks between them, in
cm and s. Uncorrected accelerations from film are pairs of time and value, in files without a sampling rate.
"""

import re
from collections.abc import Sequence

import numpy as np

from dembound.records.channel import Record
from dembound.records.formats.numbers import Flaw
from dembound.records.formats.source import Format, Source

FIRST = re.compile(r"\s*\d\s+((?:UN)?CORRECTED ACCELEROGRAM|VELOCITY|DISPLACEMENT|RESPONSE|FOURIER)\b")
UNITS = {"ACCELEROGRAM": "cm/s²", "VELOCITY": "cm/s", "DISPLACEMENT": "cm"}

TEXTS, INTEGERS, REALS = 11, 48, 50
COUNT, UNKNOWN, RATE, PEAKS = 16, 0, 1, (29, 31)
"""Places of the number of values among the integers; among the numbers, of the one that stands for an unknown one, the
sampling rate, and the largest and smallest value."""


class Smc(Format):
    """Accelerations, velocities or displacements, by the first line."""

    name = "USGS SMC"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first line is a number and one of the titles of the format."""
        return FIRST.match(lines[0]) is not None

    def read(self, source: Source) -> Record:
        """The component of the file."""
        first = FIRST.match(source.lines[0])
        assert first is not None
        if (kind := first[1].split()[-1]) not in UNITS:
            raise Flaw("holds a spectrum, must be a time series")
        integers = source.fixed(TEXTS, INTEGERS, "(8I10)")
        reals = source.fixed(TEXTS + 6, REALS, "(5E15.7)")
        texts = source.fields(TEXTS + 6, REALS, "(5E15.7)")
        begin = TEXTS + 16
        while source.line(begin).startswith("|"):
            begin += 1
        if not 0.0 < integers[COUNT] < 1e9:
            raise Flaw(f"states {integers[COUNT]:g} values in line {TEXTS + 3}, must be positive")
        numbers, time, rate = source.free(begin, int(integers[COUNT]), may_follow=True), 0.0, reals[RATE]
        found = None
        if 0.0 < rate < reals[UNKNOWN]:
            step: float | None = 1.0 / float(rate)
        elif source.given.time_step is not None:
            if (numbers[2::2] > numbers[:-2:2]).all():
                raise Flaw("has pairs of time and value; leave --dt out")
            step = None
        else:
            points = numbers[: len(numbers) // 2 * 2].reshape(-1, 2)
            try:
                (step, numbers), time = source.from_film(points[:, 0], points[:, 1]), float(points[0, 0])
            except Flaw as flaw:
                raise Flaw(f"{flaw}; if the numbers are no pairs of time and value, give --dt") from None
            found = float(np.abs(points[:, 1]).max())
        known = [place for place in PEAKS if reals[place] != reals[UNKNOWN]]
        peak = texts[max(known, key=lambda place: abs(reals[place]))] if known else ""
        named = source.found(r"^station\s*=\s*(.*?)\s*component\s*=\s*(.*?)\s*$", 0, TEXTS, "station and component")
        title = f"{named[1]}, {' '.join(source.lines[3].split())}"
        channel = source.channel(named[2], source.measured(UNITS[kind]), numbers, step, time, peak, found)
        return Record("USGS SMC", title, (channel,))

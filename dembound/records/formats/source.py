"""The base of every format; the text of a file of ground motion, its numbers, and the channels made of them."""

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.estimates import FEWEST
from dembound.gauge.reading.signal import evenly
from dembound.records.channel import Channel, Record
from dembound.records.formats.numbers import (
    MOTIONS,
    NUMBER,
    Flaw,
    _columns_of,
    number_of,
    quantity_named,
    require_increasing,
    rows_of,
    with_rounding,
)
from dembound.table import LARGEST, SMALLEST
from dembound.waves.unit_names import Named, unit_named

USUAL = "g, gal, cm/s², m/s², cm/s, m/s, cm or m"
SI = {"acceleration": "m/s²", "velocity": "m/s", "displacement": "m"}

PEAK_TOLERANCE = 1e-3
"""Share of a stated peak by which that of the samples may differ, beside the rounding of the stated one."""

LENGTH_TOLERANCE, SAME = 0.02, 0.01
"""Shares of a stated length, which is often rounded, and of a time step by which those of the samples may differ."""


FACTOR = re.compile(
    r"(?:scal(?:e|ing)|multiplication) factor|\bmultipl(?:y|ied|ier)\b|factor de escala"
    r"|(?:\bg|gal|s2|s²|s\^2|s/s)\)? *\(?[x*×] *[\d.]+",
    re.IGNORECASE,
)
"""A factor in a header: whether the numbers have it is not said."""

LONGEST = 10
"""Times the number of digitised points that even ones may have."""


END = re.compile(r"\s*(/&|end-of-data|\*+\s*end\b|end\s*$)", re.IGNORECASE)
"""The line behind the samples of a channel."""


@dataclass(frozen=True)
class Reading:
    """What is given about a file beside its header; without arguments the header alone counts.

    unit : of the values, in place of that in the header. time_step : s, where the header states none. columns : names
    of the columns of a text, in their order, "-" for one that is left out, "time" for times. series : whether all
    numbers of a text are one channel, line by line. skip : lines of a text above its header that are not read.
    """

    unit: str | None = None
    time_step: float | None = None
    columns: Sequence[str] = ()
    series: bool = False
    skip: int = 0

    @property
    def is_of_text(self) -> bool:
        """Whether it arranges numbers, which formats of networks do themselves."""
        return bool(self.columns or self.series or self.skip)


@dataclass(frozen=True)
class Source:
    """A file that is being read.

    path; lines : without their ends; given : what is known beside its header; remarks : what the reader notices on its
    way, warnings; chosen : what it took for what, where a text could be read otherwise; quantities : that the header
    states, also where a unit is given.
    """

    path: Path
    lines: Sequence[str]
    given: Reading = Reading()
    remarks: list[str] = field(default_factory=list)
    chosen: list[str] = field(default_factory=list)
    quantities: set[str] = field(default_factory=set)

    def line(self, index: int) -> str:
        """A line by its index; raises Flaw if the file ends before."""
        if index >= len(self.lines):
            raise Flaw(f"ends within the header, at line {len(self.lines)}")
        return self.lines[index]

    def channels(self, read: Callable[["Source", int], tuple[list[Channel], int]]) -> tuple[Channel, ...]:
        """All channels of a file; read : gives those that begin at a line, by its index, and the index of their end."""
        found: list[Channel] = []
        begin = 0
        while begin < len(self.lines):
            if self.lines[begin].strip():
                more, begin = read(self, begin)
                found += more
            begin += 1
        return tuple(found)

    def require_no_factor(self, header: Iterable[tuple[int, str]]) -> None:
        """Raise Flaw for a factor of the numbers in lines of a header, with their numbers, unless the unit is given."""
        for number, text in header if self.given.unit is None else ():
            if factor := FACTOR.search(text):
                said = f'line {number} has a factor, "{factor[0].strip()}", which the numbers may have or not'
                raise Flaw(f"{said}; give --unit for the numbers as they are")

    def found(self, pattern: str, begin: int, end: int, what: str) -> re.Match[str]:
        """The first match in these lines, whatever the case of letters; raises Flaw, with `what`, without one."""
        text = "\n".join(self.lines[begin:end])
        if (match := re.search(pattern, text, re.IGNORECASE | re.MULTILINE)) is None:
            text = f"; --skip {end} reads what is below as columns of text, with --dt, --unit and --columns"
            raise Flaw(f"lines {begin + 1} to {end} do not state {what}{text}")
        return match

    def fields(self, first: int, count: int, layout: str) -> list[str]:
        """`count` fields of a Fortran layout such as "(8f9.6)", from line index `first` on.

        Raises Flaw for another layout, a file or channel that ends before, and more numbers in the last line.
        """
        (per, width), rows = _columns_of(layout), rows_of(count, layout)
        if first + rows > len(self.lines):
            raise Flaw(f"ends at line {len(self.lines)}, before {count} numbers")
        for index in range(first, first + rows):
            if END.match(self.lines[index]):
                read = f"{per * (index - first)} of {count} numbers or fewer"
                raise Flaw(f"line {index + 1} ends the channel after {read}")
        lines = self.lines[first : first + rows]
        fields = [line[at : at + width] for line in lines for at in range(0, per * width, width)]
        if "".join(fields[count:]).strip():
            raise Flaw(f"line {first + rows} has more than the last of {count} numbers")
        return fields[:count]

    def fixed(self, first: int, count: int, layout: str) -> np.ndarray:
        """The numbers (count,) of `fields`; raises Flaw as well for what is no number."""
        found: list[float] = []
        for text in self.fields(first, count, layout):
            if (value := number_of(text)) is None:
                number = first + 1 + len(found) // _columns_of(layout)[0]
                raise Flaw(f'line {number} has "{text.strip()}" in place of a number')
            found.append(value)
        return np.array(found)

    def free(self, first: int, count: int, *, may_follow: bool = False) -> np.ndarray:
        """The numbers (count,) from line index `first` on, separated by blanks or signs, up to a line that ends them.

        Raises Flaw for fewer ones, for other text, and for more ones but zeros, which fill a line; with `may_follow`
        others are remarked on.
        """
        found: list[float] = []
        for index, line in enumerate(self.lines[first:], start=first):
            if END.match(line):
                break
            numbers = [number_of(text) for text in line.split()]
            if None in numbers:
                if NUMBER.sub("", line).strip():
                    raise Flaw(f'line {index + 1} has "{line.strip()[:30]}" in place of numbers')
                numbers = [number_of(text) for text in NUMBER.findall(line)]
            found += [number for number in numbers if number is not None]
        if len(found) < count:
            raise Flaw(f"ends at line {len(self.lines)}, after {len(found)} of {count} numbers")
        if any(found[count:]):
            more = f"{len(found) - count} numbers behind the {count} that the header states"
            if not may_follow:
                raise Flaw(f"has {more}")
            self.remarks.append(f"{more} are left out")
        return _sound(np.array(found[:count]))

    def measured(self, text: str, named: str = "") -> Named:
        """The unit that is given, or else that of a text in the header.

        named : words that name the quantity of the values. Raises Flaw if there is no unit, if it is none of a motion,
        and if these words name another quantity than a unit of the header.
        """
        if re.search("spectr", named, re.IGNORECASE):
            raise Flaw("holds a spectrum, must be a time series")
        stated = unit_named(text)
        self.quantities.update(filter(None, [stated.quantity if stated else quantity_named(named)]))
        if stated is not None and stated.quantity in ("counts", "voltages"):
            raise Flaw(f"has {stated.quantity} ({text.strip()}), must be converted to {' or '.join(MOTIONS)} before")
        if self.given.unit is not None:
            given = unit_named(self.given.unit)
            assert given is not None, "checked by read_record"
            if stated is not None and stated[1:] != given[1:]:
                self.remarks.append(f"--unit: {self.given.unit} given, the header says {text.strip()}")
            return given
        if stated is None:
            unknown = f'"{text.strip()}" as unit of the values, which is not known'
            raise Flaw(f"states {unknown if text.strip() else 'no unit of the values'}; give it by --unit: {USUAL}")
        if stated.quantity not in MOTIONS:
            raise Flaw(f"has {stated.quantity} ({text.strip()}), must have {' or '.join(MOTIONS)}")
        if (quantity := quantity_named(named)) and quantity != stated.quantity:
            raise Flaw(f"has {quantity} in {text.strip()}, which measures {stated.quantity}; give the right --unit")
        return stated

    def evenly(self, time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times (k,) s and values at even times; raises Flaw for times that do not increase or have gaps."""
        require_increasing(time)
        try:
            time, values, notes = evenly(self.path, time, _sound(values))
        except CaseError as error:
            raise Flaw(error.problems[0].removeprefix(f"{self.path}: ")) from None
        self.remarks.extend(notes)
        return time, values

    def from_film(self, time: np.ndarray, values: np.ndarray) -> tuple[float, np.ndarray]:
        """The median of the time steps (s) of digitised points (k,), and values at such steps on lines between them.

        Points at the same time count with their mean. Raises Flaw for times that go back.
        """
        require_increasing(time)
        time, place = np.unique(time, return_inverse=True)
        values = np.bincount(place, _sound(values)) / np.bincount(place)
        step = float(f"{np.median(np.diff(time)):.6g}")  # of times with few digits
        if (time[-1] - time[0]) / step > LONGEST * len(time):
            raise Flaw(f"has gaps of up to {np.diff(time).max():.4g} s between points {step:.4g} s apart")
        even = np.arange(time[0], time[-1] + 1e-6 * step, step)
        self.remarks.append(f"digitised at uneven times, resampled every {step:.4g} s by straight lines")
        return step, np.interp(even, time, values)

    def channel(
        self,
        component: str,
        unit: Named,
        numbers: np.ndarray,
        time_step: float | None,
        begin: float = 0.0,
        peak: str = "",
        found: float | None = None,
        length: str = "",
    ) -> Channel:
        """A channel in SI.

        Parameters
        ----------
        unit : by `measured`. numbers : (n,) in this unit. time_step : s; None where the header states none. peak : as
        the header states it in this unit; other text for none. found : what the stated peak is compared with; by
        default the largest size of the numbers. length : of the record, s, as the header states it, or other text.

        Raises Flaw for too few samples, samples that are not finite, a time step that is not positive, missing, or
        another one than is given, another length than the stated one, and another peak, unless the unit is given.
        """
        quantity, size, spelled = MOTIONS[unit.quantity], unit.size, unit.spelled.strip()
        if len(numbers) < FEWEST:
            raise Flaw(f"has {len(numbers)} samples, must have {FEWEST} or more")
        time_step = self._given_step(time_step)
        if not SMALLEST <= time_step <= LARGEST:
            raise Flaw(f"has a time step of {time_step:g} s, must be positive")
        stated, rounding = with_rounding(length)
        tolerance = 2.0 * time_step + LENGTH_TOLERANCE * (stated or 0.0) + rounding
        if stated and self.given.time_step is None and abs(len(numbers) * time_step - stated) > tolerance:
            have = f"{len(numbers)} samples, one every {time_step:g} s, have {len(numbers) * time_step:g} s"
            said = f"the header states a length of {stated:g} s, {have}; if they are right, give --dt {time_step:g}"
            raise Flaw(f"{component or quantity}: {said}")
        values = size * _sound(numbers)
        stated, rounding = with_rounding(peak)
        if stated is None:
            return Channel(component, quantity, values, time_step, begin, unit=spelled)
        found = float(np.abs(numbers).max()) if found is None else found
        if abs(found - stated) > PEAK_TOLERANCE * stated + rounding:
            states, have = (f"{size * each:.4g} {SI[quantity]}" for each in (stated, found))
            said = f"{component or quantity}: the header states a peak of {states}, the samples have {have}"
            if self.given.unit is None:
                raise Flaw(f"{said}; to read it nevertheless, give the unit by --unit")
            self.remarks.append(said)
        return Channel(component, quantity, values, time_step, begin, size * stated, spelled)

    def _given_step(self, stated: float | None) -> float:
        """The time step (s) of the header, or that which is given; raises Flaw for none and for two."""
        given = self.given.time_step
        if stated is None and given is None:
            raise Flaw("states no time step; give it by --dt")
        if stated is not None and given is not None and abs(stated - given) > SAME * stated:
            raise Flaw(f"--dt: is {given:g} s, the file states {stated:g} s; leave it out")
        return stated if stated is not None else float(given or 0.0)


def _sound(numbers: np.ndarray) -> np.ndarray:
    """Samples as they are; raises Flaw if one is not finite."""
    if not (sound := np.abs(numbers) <= LARGEST).all():
        raise Flaw(f"sample {int(np.argmin(sound)) + 1} is {numbers[np.argmin(sound)]:g}, must be finite")
    return numbers


class Format(ABC):
    """A format of text files; derived ones are registered under the entry point group "dembound.records"."""

    name: ClassVar[str]
    """As messages print it, with its versions."""

    @abstractmethod
    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the lines of a file, at least one, begin as those of this format."""

    @abstractmethod
    def read(self, source: Source) -> Record:
        """The channels of a file that is recognised; raises `Flaw` for what cannot be read."""

"""V1 and V2 files of the Consortium of Organizations for Strong-Motion Observation Systems (COSMOS), format 1.20.

A channel has lines of text, whose number is in the first one, integers, numbers, comments and samples. A line before
each of these four has their number and, but for comments, their layout.
"""

import re
from collections.abc import Sequence

from dembound.records.channel import Channel, Record
from dembound.records.formats.numbers import COUNT, Flaw, rows_of
from dembound.records.formats.source import END, Format, Source
from dembound.waves.unit_names import unit_named

FIRST = re.compile(r".*\(format v[\d.]+ with\s+(\d{1,3}) text lines\)", re.IGNORECASE)
INTEGERS = rf"^\s*{COUNT} integer-header.*format\s*=\s*(\(.*)"
REALS = rf"^\s*{COUNT} real-header.*format\s*=\s*(\(.*)"
COMMENTS = rf"^\s*{COUNT} comment line"
SAMPLES = rf"^\s*{COUNT} (?:.*?approx\s+(\d+)\s+secs)?.*units\s*=\s*([^(]*?)\.?\s*\(\s*\d+\s*\).*format\s*=\s*(\(.*)"
COMPONENT = r"^sta cha\w*:?\s*\S+?\s*:[ ]*(.*?)\s*(?:deg\b.*)?(?:\(.*)?$"
CODE = re.compile(r"<SCNL>[^.\s]*\.([^.\s]+)\.")
"""The direction in the text; station, component, network and place in a comment."""

PEAK_UNIT = re.compile(r"^Processed:.*\bMax\s*=\s*\S+\s+(\S+)\s+at\b", re.MULTILINE)
"""The unit of the processed peak in the text."""

STEP, PEAK = 61, 63
"""Places of the time step (ms) and of the peak among the numbers of the header."""

UNKNOWN = -999.0


class Cosmos(Format):
    """Each channel has one quantity."""

    name = "COSMOS"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first line states a version and the number of lines of text."""
        return FIRST.match(lines[0]) is not None

    def read(self, source: Source) -> Record:
        """The channels of the file."""
        channels = source.channels(_channel)
        title = f"{source.line(4)[40:].strip()}, {' '.join(source.line(1).split())}"
        return Record("COSMOS", title, channels)


def _channel(source: Source, begin: int) -> tuple[list[Channel], int]:
    """The channel that begins at a line, by its index, and the index of the line that ends it."""
    first = FIRST.match(source.lines[begin])
    if first is None:
        raise Flaw(f"line {begin + 1} is not the first one of a channel")
    at = begin + int(first[1])
    component = source.found(COMPONENT, begin, at, "the component")[1]
    integers = source.found(INTEGERS, at, at + 1, "number and layout of integers")
    at += 1 + rows_of(int(integers[1]), integers[2])
    stated = source.found(REALS, at, at + 1, "number and layout of real numbers")
    count, layout = int(stated[1]), stated[2]
    if count <= PEAK:
        raise Flaw(f"line {at + 1} states {count} real numbers, must be 100")
    reals = source.fixed(at + 1, count, layout)
    peak = source.fields(at + 1, count, layout)[PEAK] if reals[PEAK] != UNKNOWN else ""
    at += 1 + rows_of(count, layout)
    comments = int(source.found(COMMENTS, at, at + 1, "the number of comment lines")[1])
    code = CODE.search("\n".join(source.lines[at + 1 : at + 1 + comments]))
    at += 1 + comments
    samples = source.found(SAMPLES, at, at + 1, "number, unit and layout of samples")
    unit = source.measured(samples[3], source.line(at))
    of_peak = PEAK_UNIT.search("\n".join(source.lines[begin : begin + int(first[1])]))
    if of_peak and (named := unit_named(of_peak[1])) is not None and named[1:] != unit[1:] and not source.given.unit:
        raise Flaw(f"line {at + 1} states {samples[3]}, the text a peak in {of_peak[1]}; give the unit by --unit")
    values = source.fixed(at + 1, int(samples[1]), samples[4])
    at += 1 + rows_of(int(samples[1]), samples[4])
    if at < len(source.lines) and not END.match(source.lines[at]):
        raise Flaw(f"line {at + 1} does not end the channel, after {len(values)} samples")
    name = code[1] if code and component.lower() in ("", "other") else component
    step, length = 1e-3 * float(reals[STEP]), samples[2] or ""
    if length and abs(len(values) * step - int(length)) <= 1.0:  # in whole seconds, rounded in any direction
        length = ""
    return [source.channel(name, unit, values, step, peak=peak, length=length)], at

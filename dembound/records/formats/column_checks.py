"""Checks of columns of numbers beside their header, which raise `Flaw` where they contradict each other."""

import re
from collections.abc import Sequence

import numpy as np

from dembound.records.channel import Channel
from dembound.records.formats.numbers import MOTIONS, Flaw, number_of
from dembound.records.formats.source import SAME, Source
from dembound.records.formats.table import EITHER, Head, Table
from dembound.waves.unit_names import unit_named

NUMBER = r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[Ee][+-]?\d+)?)"

PEAK = re.compile(
    r"\b(?:pg[avd]|\w*ppv|(?:peak|max(?:imum|\.)?)(?: ground| value)?(?: (?:acc|vel|disp)\w*\.?)?)"
    rf"\s*(?:[\[(]([^\])]*)[\])])?\s*(?:[=:]|\"?,\"?)?\s*{NUMBER}\s*([^\s,;\"]*)",
    re.IGNORECASE,
)
"""A peak in a header, its unit before or behind it."""


CHANNELS = re.compile(r"\b(?:channels|components)(?:\s*[=:]\s*|\t)(\d{1,3})\b(?!\s*[-,;&/]\s*\d)", re.IGNORECASE)
"""The number of channels in a header."""


SMOOTHER = 0.7
"""Ratio of mean differences between neighbours at which numbers contradict the order in which they are read."""


def require_motions(
    table: Table, heads: Sequence[Head], values: np.ndarray, timed: Sequence[int], chosen: Sequence[int]
) -> None:
    """Raise Flaw for values over periods, which are never negative, and for another number of channels than stated."""
    about = any(re.search("spectr|谱", text, re.IGNORECASE) for _, text in table.header)
    may_be = any(heads[at].name == "T" or (about and heads[at].name in ("", "t")) for at in timed)
    if may_be and (values[chosen] >= 0.0).all():
        at = timed[0] + 1
        raise Flaw(f"column {at} may have periods, as no value is negative: name it by --columns, time if it has times")
    for number, text in table.header if len(chosen) > 1 else ():
        if (found := CHANNELS.search(text)) and int(found[1]) != len(chosen):
            raise Flaw(f"line {number} states {found[1]} channels, there are {len(chosen)}; name them by --columns")


def require_no_card(source: Source) -> None:
    """Raise Flaw for a card of LS-DYNA, the first numbers of a curve, with factors or offsets other than 1 and 0."""
    lines = list(enumerate(source.lines, start=1))[source.given.skip :]
    curve = next((at for at, (_, text) in enumerate(lines) if re.match(r"\*define_curve", text, re.IGNORECASE)), None)
    for number, card in [] if curve is None else lines[curve + 1 :]:
        fields = card.split(",") if "," in card else [card[at : at + 10] for at in range(0, 60, 10)]
        if number_of(fields[0]) is not None:
            factors, offsets = ([number_of(text) or 0.0 for text in some] for some in (fields[2:4], fields[4:6]))
            if any(offsets) or any(factor not in (0.0, 1.0) for factor in factors):
                said = f"line {number} has factors or offsets of the numbers"
                raise Flaw(f"{said}; apply them, and leave it out by --skip {number}")
            return


def compare_peaks(source: Source, table: Table, channels: Sequence[Channel]) -> None:
    """Remark on a stated peak that none of several channels has; it may be that of their resultant."""
    for number, text in table.header:
        for found in PEAK.finditer(text):
            named = unit_named(found[1] or found[3] or "")
            if named is None or named.quantity not in MOTIONS:
                continue
            peak = float(found[2].replace(",", ".")) * named.size
            peaks = [np.abs(each.values).max() for each in channels if each.quantity == MOTIONS[named.quantity]]
            if peaks and all(abs(each - abs(peak)) > SAME * each for each in peaks):
                source.remarks.append(f"line {number} states a peak that no channel has: {found[0].strip()}")


def require_order(table: Table, *, series: bool) -> None:
    """Raise Flaw if the numbers are much smoother in the other order than that in which they are read."""
    values = np.array(table.rows[: table.ragged])
    if len(values) < 2:
        return
    along, down = np.abs(np.diff(values.ravel())).mean(), np.abs(np.diff(values, axis=0)).mean()
    if (down < SMOOTHER * along) if series else (along < SMOOTHER * down):
        seem = "columns" if series else "one series"
        raise Flaw(f"has {table.width} numbers in a line that seem to be {seem}: {EITHER}")

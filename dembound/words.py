"""Numbers as text, and texts by name, for tables and messages."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Literal, NamedTuple

CracksBy = Literal["kind", "time"]
"""What gives the colours of broken bonds in pictures of disks."""

Entries = Iterator[tuple[str, str]]
"""Names and their texts, in the order of printing."""

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
"""Prefixes of units, the largest first."""

UPWARDS = ("Pa", "Pa/m", "N", "N/m", "J", "J/m", "Hz")
"""Units with prefixes above 1 only, as mPa would be read as MPa.

Other units, such as of speeds, have only those below 1.
"""


def percent(share: float, digits: int = 2) -> str:
    """A share in per cent, such as "0.13 %", with `digits` digits; larger numbers with all digits before the point."""
    value = 100.0 * share
    return f"{value:.{digits}g} %" if abs(value) < 10.0**digits - 0.5 else f"{value:.0f} %"


def with_unit(value: float, unit: str, digits: int = 3) -> str:
    """A number in an SI unit as text with a suitable prefix: 1.25e6 Pa is "1.25 MPa"."""
    (text,), prefixed = in_one_unit([value], unit, digits)
    return f"{text} {prefixed}"


def in_one_unit(values: Sequence[float], unit: str, digits: int = 3) -> tuple[list[str], str]:
    """Numbers as text with a number of digits, and their unit with a suitable prefix for the largest."""
    sizes = [abs(value) for value in values if math.isfinite(value)]
    largest = float(f"{max(sizes, default=0.0):.{digits}g}")  # 999,999 Pa is 1 MPa
    fitting = [each for each in PREFIXES if (each[0] >= 1.0 if unit in UPWARDS else each[0] <= 1.0)]
    factor, name = next((each for each in fitting if each[0] <= largest), fitting[-1] if largest > 0.0 else (1.0, ""))
    return [f"{float(f'{value / factor:.{digits}g}'):.12g}" for value in values], f"{name}{unit}"


class Quantity(NamedTuple):
    """A number under a name, for scripts, and what is said of it.

    name : its key in ``summary.json``. value : plain JSON value, in its SI unit; None where there is none.
    sentence : in which {} is the number with its unit and a prefix, and {:…} the number alone; or nothing.
    """

    name: str
    unit: str
    value: Any
    sentence: str = ""

    @property
    def text(self) -> str:
        """The sentence with its number; empty without one."""
        if self.value is None:
            return ""
        return self.sentence.format(with_unit(self.value, self.unit) if "{}" in self.sentence else self.value)


def numbers(quantities: Iterable[Quantity]) -> dict[str, Any]:
    """The values of quantities by name, as in ``summary.json``."""
    return {each.name: each.value for each in quantities}


def sentences(quantities: Iterable[Quantity], *names: str) -> str:
    """What is said of the quantities with these names, of which there is a number, with commas between."""
    texts = {each.name: each.text for each in quantities}
    return ", ".join(text for name in names if (text := texts[name]))


def columns(rows: Sequence[Sequence[str]], left: int = 1) -> list[str]:
    """Rows of equally many cells as lines with aligned columns, the first few to the left, others to the right."""
    wide = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    return [
        "  ".join(
            f"{cell:{'<' if place < left else '>'}{width}}"
            for place, (cell, width) in enumerate(zip(row, wide, strict=True))
        ).rstrip()
        for row in rows
    ]

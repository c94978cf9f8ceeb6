"""Numbers in files of ground motion as their writers format them, and the quantities that texts name."""

import math
import re
from decimal import Decimal, InvalidOperation

import numpy as np

from dembound.gauge.estimates import FEWEST
from dembound.records.channel import Quantity
from dembound.table import LARGEST
from dembound.waves.unit_names import unit_named

MOTIONS: dict[str, Quantity] = {
    "accelerations": "acceleration",
    "velocities": "velocity",
    "displacements": "displacement",
}
"""Quantities by their names in `unit_names`."""


QUANTITY = {
    "accelerations": re.compile(r"\b(?:acc|accel\w*|acel\w*|beschl\w*)(?![a-z])|加速度", re.IGNORECASE),
    "velocities": re.compile(r"\b(?:vel|veloc\w*|geschw\w*|vitesse)(?![a-z])|(?<!加)速度", re.IGNORECASE),
    "displacements": re.compile(r"\b(?:disp|displ\w*|despl\w*|versch\w*)(?![a-z])|位移", re.IGNORECASE),
}
"""Words, also shortened, of several languages that name a quantity."""


COUNT = r"(\d{1,9})"
DECIMAL = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?"
"""Patterns of a number of samples and of any number, Fortran's double precision (1.5D-03) included."""


SECONDS = r"((?:milli|micro)?seconds?|[mu]?sec|m?secs|[mµμu]?s|min(?:ute)?s?)"
BARE = 0.1
"""The unit of a time step, and the longest one that is taken in seconds without a unit, s."""


NUMBER = re.compile(DECIMAL)
FORTRAN = re.compile(r"([+-]?(?:\d+\.\d*|\.\d+))(?:[Dd]([+-]?\d+)|([+-]\d{3}))")
"""A number that float() does not read: double precision, or without the letter before an exponent of three digits."""


LAYOUT = re.compile(r"\(\s*(\d*)\s*[a-z]+(\d+)(?:\.\d+)?[^()]*\)", re.IGNORECASE)


class Flaw(Exception):  # noqa: N818  # what is wrong with a file, not with the program
    """What is wrong in a file, in one line without its path."""


class Unknown(Flaw):
    """The file is of no known format."""


def require_increasing(time: np.ndarray) -> None:
    """Raise Flaw for times (k,) that are too few, not finite or go back."""
    if len(time) < FEWEST:
        raise Flaw(f"has {len(time)} samples, must have {FEWEST} or more")
    if not (np.abs(time) <= LARGEST).all():
        raise Flaw("has times that are not finite")
    steps = np.diff(time)
    if (steps < 0.0).any() or time[0] == time[-1]:
        at = int(np.argmin(steps))
        raise Flaw(f"must have times that increase: {time[at + 1]:.6g} s is behind {time[at]:.6g} s")


def number_of(text: str) -> float | None:
    """The number in a text, in Fortran's spellings too, nan and inf included; None for other texts."""
    try:
        return float(text) if "_" not in text else None
    except ValueError:
        found = FORTRAN.fullmatch(text.strip())
        return float(f"{found[1]}e{found[2] or found[3]}") if found else None


def seconds_of(number: str, unit: str, line: int) -> float:
    """A time step (s) of the header from a number, with a decimal comma too, and a unit by `SECONDS` or none.

    line : its number. Raises Flaw for a long one without a unit.
    """
    step = float(number.replace(",", "."))
    if not unit and step > BARE:
        raise Flaw(f'line {line} states a time step of {step:g} without a unit: write "{step:g} ms" or "{step:g} s"')
    named = unit_named(unit.lower() or "s")
    assert named is not None, "SECONDS has known units alone"
    return step * named.size


def quantities_named(words: str) -> set[str]:
    """The quantities of motions in a text, by their names in `MOTIONS`."""
    return {quantity for quantity, pattern in QUANTITY.items() if pattern.search(words)}


def quantity_named(words: str) -> str | None:
    """The quantity of a motion in a text, by its name in `MOTIONS`; None for other texts, and for several."""
    found = quantities_named(words)
    return found.pop() if len(found) == 1 else None


def rows_of(count: int, layout: str) -> int:
    """Lines of `count` numbers in a Fortran layout; raises Flaw for another text."""
    return -(-count // _columns_of(layout)[0])


def _columns_of(layout: str) -> tuple[int, int]:
    """Numbers in a line and characters of a number in a Fortran layout; raises Flaw for another text."""
    found = LAYOUT.search(layout)
    if found is None or not (size := (int(found[1] or 1), int(found[2])))[0] * size[1]:
        raise Flaw(f'"{layout.strip()}" is not a layout such as (8f9.6)')
    return size


def with_rounding(text: str) -> tuple[float | None, float]:
    """Size of a number, None for other text, and half of its last digit."""
    try:
        number = Decimal(text.strip())
        exponent = number.as_tuple().exponent
    except InvalidOperation:
        return None, 0.0
    size = abs(float(number))
    if not isinstance(exponent, int) or not math.isfinite(size) or size > LARGEST:
        return None, 0.0
    return size, 0.5 * 10.0 ** max(min(exponent, 300), -300)

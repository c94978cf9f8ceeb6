"""Keys that are varied: lists of values, and ranges of whole numbers, of the tables ``[chart]`` and ``[sweep]``."""

import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator

RANGE = re.compile(r"(-?\d{1,18}):(-?\d{1,18})(?::(\d{1,18}))?")
"""First and last whole number, and maybe the step from one to the next."""

MOST_VALUES = 100_000
"""Largest number of values of a key."""


def range_of(text: Any) -> list[int] | None:
    """The whole numbers of a range: "1:20" is 1, 2, … 20, "0:100:25" is 0, 25, … 100; None for anything else.

    Raises ValueError for a range without a number, and for one of more than `MOST_VALUES`.
    """
    found = RANGE.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        return None
    first, last, step = int(found[1]), int(found[2]), int(found[3] or 1)
    if step == 0 or last < first:
        raise ValueError(f"{text} is a range without a number, must be FIRST:LAST or FIRST:LAST:STEP upwards")
    if (last - first) // step >= MOST_VALUES:
        raise ValueError(f"{text} has more than {MOST_VALUES:,} numbers")
    return list(range(first, last + 1, step))


def _lists(vary: dict[str, Any]) -> dict[str, Any]:
    """The lists by dotted key, also where TOML has made a table of every dot."""
    flat = dict(_flattened(vary, ""))
    found = {key: range_of(values) or values for key, values in flat.items()}
    if wrong := [key for key, values in found.items() if not isinstance(values, list) or not values]:
        raise ValueError(f'{wrong[0]} must have a list of values, such as [0.25, 0.5], or a range, such as "1:20"')
    return found


def _flattened(tables: Mapping[str, Any], place: str) -> Iterator[tuple[str, Any]]:
    """Entries of nested tables by dotted key."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{place}{name}.")
        else:
            yield f"{place}{name}", value


Vary = Annotated[dict[str, Any], AfterValidator(_lists)]
"""Dotted key -> list of values; in a file a range may stand in place of a list."""

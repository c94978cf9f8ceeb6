"""Estimated errors of a run, stored beside its record: histories of the errors, and their sizes in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dembound.results.reader import open_record
from dembound.words import Entries, percent

FILE = "estimate.h5"
"""Histories of the errors, in the folder of the results."""

KEY = "error_estimate"
"""Entry of the summary."""

NAMES = {"disks": "these disks", "rock": "the rock"}
"""Motions relative to which errors are given, in words."""

LEAST = 1e-3
"""Smallest error that is given as a number."""


@dataclass(frozen=True)
class Band:
    """The estimated error of a monitor's history.

    time (k,) s. half_width (k, c), in SI units: largest expected error at every time. corrected (k, c): the history
    without the error of the sides, None where this is not known.
    """

    time: np.ndarray
    half_width: np.ndarray
    corrected: np.ndarray | None


def read_bands(record: Path, quantity: str) -> dict[str, Band]:
    """The bands of a quantity by monitor for the run of a record; none without an estimate.

    Raises RecordError for a file that cannot be read.
    """
    path = record.with_name(FILE)
    if not path.is_file():
        return {}
    with open_record(path) as file:
        return {
            name: Band(
                group["time"][:],
                group[quantity]["band"][:],
                group[quantity]["corrected"][:] if "corrected" in group[quantity] else None,
            )
            for name, group in file["histories"].items()
            if quantity in group
        }


def in_words(share: float) -> str:
    """A share in per cent with two digits, at least `LEAST`."""
    return f"< {percent(LEAST)}" if share < LEAST else percent(share)


def split_in_words(shares: Mapping[str, float]) -> str:
    """Shares by cause, the largest first."""
    ordered = sorted(shares.items(), key=lambda each: -each[1])
    return ", ".join(f"{name} {in_words(share)}" for name, share in ordered)


def entries(estimate: Mapping[str, Any]) -> Entries:
    """The entry of a summary as names and texts: errors at each monitor, their origin, and missing causes."""
    for monitor, quantities in estimate["monitors"].items():
        for quantity, found in quantities.items():
            totals = ", ".join(f"of {NAMES[of]} {_between(each)}" for of, each in found["of"].items())
            yield f"{monitor}, {quantity}", f"{totals} ({split_in_words(found['by'])})"
    yield from ((name, f"{cause['how']}, {cause['words']}") for name, cause in estimate["causes"].items())
    for name, lines in (("notes", estimate["notes"]), ("not estimated", estimate["not_estimated"])):
        if lines:
            yield name, "; ".join(lines)


def _between(share: Mapping[str, float]) -> str:
    """An error and its upper bound, in words."""
    return f"{in_words(share['value'])}, at most {percent(share['upper'])}"

"""What tables and messages have in common: numbers as text, and texts by name."""

from collections.abc import Iterator

Entries = Iterator[tuple[str, str]]
"""Names, each with what is said under it, in the order in which they are printed."""


def percent(share: float, digits: int = 2) -> str:
    """A share in per cent, such as "0.13 %", with so many digits, or all of a whole number with more."""
    value = 100.0 * share
    return f"{value:.{digits}g} %" if abs(value) < 10.0**digits - 0.5 else f"{value:.0f} %"

"""Numbers as text, and texts by name, for tables and messages."""

from collections.abc import Iterator

Entries = Iterator[tuple[str, str]]
"""Names, each with what is said under it, in the order in which they are printed."""


def percent(share: float, digits: int = 2) -> str:
    """A share in per cent, such as "0.13 %", with `digits` digits; larger numbers with all digits before the point."""
    value = 100.0 * share
    return f"{value:.{digits}g} %" if abs(value) < 10.0**digits - 0.5 else f"{value:.0f} %"

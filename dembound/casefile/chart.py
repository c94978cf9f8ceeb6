"""The ``[chart]`` table: the choices of which `dembound chart` draws error against cost."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import field_validator

from dembound.table import Table, quantity

ReferenceName = Literal["exact", "extended", "finer", "finest"]

End = Literal["break", "end"]


class ChartChoice(Table):
    """A named choice: some keys of the case, each with another value."""

    name: str = quantity(..., unit="1", help="name of the choice in the chart", min_length=1)
    set: dict[str, Any] = quantity(..., unit="1", help='changed keys, such as {"run.safety" = 0.5}')


class Chart(Table):
    """The choices of a chart, how often each is run, and what errors are measured against."""

    vary: dict[str, Any] = quantity(
        {}, unit="1", help="key -> list of values; all combinations of the keys' values are choices"
    )
    choice: tuple[ChartChoice, ...] = quantity((), unit="1", help="additional choices, a table each")
    repeats: int = quantity(3, unit="1", help="timed runs of every choice, after one that compiles", ge=1)
    reference: ReferenceName | None = quantity(
        None, unit="1", help="what errors are measured against; absent: the first of these that the case allows"
    )
    until: End = quantity(
        "break",
        unit="1",
        help='up to when histories are compared: the first spall or broken bond of the reference, or the "end"',
    )

    @field_validator("vary")
    @classmethod
    def _lists(cls, vary: dict[str, Any]) -> dict[str, Any]:
        """The lists by dotted key, also where TOML has made a table of every dot."""
        flat = dict(_flattened(vary, ""))
        if wrong := [key for key, values in flat.items() if not isinstance(values, list) or not values]:
            raise ValueError(f"{wrong[0]} must have a list of values, such as [0.25, 0.5]")
        return flat


def _flattened(tables: Mapping[str, Any], place: str) -> Iterator[tuple[str, Any]]:
    """Entries of nested tables by dotted key."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{place}{name}.")
        else:
            yield f"{place}{name}", value

"""The ``[chart]`` table: the choices of which `dembound chart` draws error against cost."""

from typing import Any, Literal

from dembound.casefile.vary import Vary
from dembound.table import Table, quantity

ReferenceName = Literal["exact", "extended", "finer", "finest"]

End = Literal["break", "end"]

MOST_REPEATS = 1000
"""Largest number of timed runs: the fastest of a few is as fast as that of many, to some per cent."""


class ChartChoice(Table):
    """A choice of which several keys change together."""

    name: str = quantity(..., unit="1", help="name of the choice in the chart", min_length=1)
    set: dict[str, Any] = quantity(..., unit="1", help='changed keys, such as { "run.safety" = 0.5 }')


class Chart(Table):
    """Choices that `dembound chart` compares; runs do not depend on it."""

    vary: Vary = quantity(
        {}, unit="1", help='key -> list of values, or range such as "1:20"; all combinations are choices'
    )
    choice: tuple[ChartChoice, ...] = quantity((), unit="1", help="additional choices, a table [[chart.choice]] each")
    repeats: int = quantity(
        3, unit="1", means="count", help="timed runs of every choice, after one that compiles", ge=1, le=MOST_REPEATS
    )
    reference: ReferenceName | None = quantity(
        None, unit="1", help="reference of the errors; absent: the first that the case allows"
    )
    until: End = quantity(
        "break",
        unit="1",
        help='end of the compared histories: "break", the first spall or broken bond of the reference; "end"',
    )

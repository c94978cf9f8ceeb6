"""The ``[[load]]`` tables of a bar."""

from typing import Literal

from dembound.casefile.bar.bar import MOST_CELLS
from dembound.table import FileName, Table, quantity


class BarLoad(Table):
    """A pressure on one end of a bar, on its last node or spread over its last few in proportion to their volume.

    A wave's values, taken as pure numbers, are the time factor. Coarse peridynamic bars need a load on several nodes:
    on one node it breaks them.
    """

    name: FileName = quantity(..., unit="1", help="name of the load in messages and results")
    pressure: float = quantity(
        ..., unit="Pa", means="pressure of a load", help="pressure on the section; negative values pull"
    )
    side: Literal["left", "right"] = quantity("left", unit="1", help="end of the bar it acts on")
    nodes: int = quantity(
        1,
        unit="1",
        means="count",
        help="number of nodes it is spread over, from the end inwards",
        ge=1,
        le=MOST_CELLS + 1,
    )
    wave: str = quantity(..., unit="1", help="name of the wave that is the time factor")

"""The ``[run]`` table."""

from typing import Annotated, Literal

from pydantic import Field

from dembound.table import Table, quantity


class Run(Table):
    """The simulated time and the time step."""

    duration: float = quantity(..., unit="s", help="simulated time", gt=0.0)
    time_step: Annotated[float, Field(gt=0.0)] | Literal["auto"] = quantity(
        "auto", unit="s", help='time step; "auto" takes it from the stability limit'
    )
    safety: float = quantity(
        0.9, unit="1", help="share of the stability limit that an automatic step uses", gt=0.0, le=1.0
    )

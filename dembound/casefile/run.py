"""The ``[run]`` table."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from dembound.table import Table, quantity

SILENT_KEYS = ("silent_level", "silent_for")


class Run(Table):
    """Simulated time and time step, and whether the run ends when all monitors are at rest."""

    duration: float = quantity(..., unit="s", help="simulated time", gt=0.0)
    time_step: Annotated[float, Field(gt=0.0)] | Literal["auto"] = quantity(
        "auto", unit="s", help='time step; "auto" takes it from the stability limit'
    )
    safety: float = quantity(
        0.9, unit="1", means="share", help="share of the stability limit that an automatic step uses", gt=0.0, le=1.0
    )
    checkpoint: float = quantity(
        300.0,
        unit="s",
        means="wall time",
        help="wall time between two checkpoints; 0: none, and the run cannot be resumed",
        ge=0.0,
    )
    until: Literal["duration", "silent"] = quantity(
        "duration", unit="1", help='when it ends; "silent": before its duration if all monitors are silent'
    )
    silent_level: float = quantity(
        1e-3,
        unit="1",
        means="share",
        help="share of its own peak so far below which a monitor's velocity is silent",
        gt=0.0,
        lt=1.0,
    )
    silent_for: float | None = quantity(
        None,
        unit="s",
        help="time over which all monitors must be silent; absent: the longest wave, or echo from a side",
        gt=0.0,
    )

    @model_validator(mode="after")
    def _silent_keys_have_effect(self) -> "Run":
        stray = [key for key in SILENT_KEYS if self.until != "silent" and key in self.model_fields_set]
        if stray:
            raise ValueError("\n".join(f'{key}: is only allowed with until = "silent"' for key in stray))
        return self

"""The ``[run]`` table."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from dembound.table import Table, quantity

ENDING_KEYS = {"silent": ("silent_level", "silent_for"), "peak": ("peak_share", "peak_for")}
"""Ends before the duration, and the keys that belong to each."""

ENDING = ("until", *(key for keys in ENDING_KEYS.values() for key in keys))
"""Keys of ``[run]`` that end a run before its duration."""


class Run(Table):
    """Simulated time and time step, and whether the run ends before it."""

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
    until: Literal["duration", "silent", "peak"] = quantity(
        "duration",
        unit="1",
        help='when it ends; "silent": before its duration if all monitors are silent; "peak": if the forces on all '
        "sides whose motion a wave prescribes have passed their peaks",
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

    peak_share: float = quantity(
        0.7,
        unit="1",
        means="share",
        help="share of its peak, both counted from the force at the start, below which a side's force has fallen",
        gt=0.0,
        lt=1.0,
    )
    peak_for: float | None = quantity(
        None,
        unit="s",
        help="time for which all forces must have fallen; absent: until the slowest wave has crossed the body twice",
        gt=0.0,
    )

    @property
    def is_test(self) -> bool:
        """Whether it is a test to failure, in which waves are not what is studied."""
        return self.until == "peak"

    def lasting(self, duration: float) -> Self:
        """The run with another duration (s), without times of an earlier end that are longer than it."""
        times = [key for key in ("silent_for", "peak_for") if (getattr(self, key) or 0.0) > duration]
        return self.model_copy(update={"duration": duration, **dict.fromkeys(times)})

    @model_validator(mode="after")
    def _ending_keys_have_effect(self) -> "Run":
        stray = [
            f'{key}: is only allowed with until = "{until}"'
            for until, keys in ENDING_KEYS.items()
            for key in keys
            if self.until != until and key in self.model_fields_set
        ]
        if stray:
            raise ValueError("\n".join(stray))
        return self

"""The ``[run]`` table of a bar."""

from pydantic import model_validator

from dembound.casefile.run import Run
from dembound.table import quantity


class BarRun(Run):
    """The simulated time and the time step of a bar; the step may be given by the Courant number."""

    courant: float | None = quantity(
        None, unit="1", means="Courant number", help="Courant number ν = cΔt/Δx, instead of a time step", gt=0.0
    )

    @model_validator(mode="after")
    def _one_step(self) -> "BarRun":
        if self.courant is not None and self.time_step != "auto":
            raise ValueError("courant: is not allowed together with time_step")
        if self.courant is not None and "safety" in self.model_fields_set:
            raise ValueError("safety: is for an automatic time step, courant gives it")
        return self

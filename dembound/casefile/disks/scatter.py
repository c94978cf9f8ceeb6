"""The key ``pb_scatter`` of the ``[material]`` table."""

from typing import Literal

from pydantic import model_validator

from dembound.table import LARGEST_WHOLE, Table, quantity

KEY_OF = {"normal": "deviation", "weibull": "shape"}
"""The key that each distribution needs."""


class Scatter(Table):
    """Scatter of the strengths of bonds: one factor for each, of mean 1, on both `pb_ten` and `pb_coh`.

    "normal" is cut off at three deviations either side, at most 0.95, and "weibull" below 0.05. The factor of a bond
    follows from `packing.seed` and its place in the packing alone.
    """

    type: Literal["normal", "weibull"] = quantity(..., unit="1", help="distribution of the factors")
    deviation: float | None = quantity(
        None, unit="1", means="share", help='standard deviation of "normal" before it is cut off', gt=0.0, le=1.0
    )
    shape: float | None = quantity(
        None, unit="1", means="setting", help='shape (Weibull modulus) of "weibull"', ge=1.0, le=1e3
    )
    seed: int = quantity(0, unit="1", means="count", help="other strengths of the same disks", ge=0, le=LARGEST_WHOLE)

    @property
    def in_words(self) -> str:
        """The distribution and its width."""
        width = {"normal": "± {:g}", "weibull": "modulus {:g}"}[self.type].format(getattr(self, KEY_OF[self.type]))
        return f"{self.type} {width}"

    @model_validator(mode="after")
    def _one_width(self) -> "Scatter":
        needed = KEY_OF[self.type]
        problems = [] if getattr(self, needed) is not None else [f'{needed}: is missing; type = "{self.type}" needs it']
        for key in KEY_OF.values():
            if key != needed and getattr(self, key) is not None:
                problems.append(f'{key}: is not allowed with type = "{self.type}"; give {needed}')
        if problems:
            raise ValueError("\n".join(problems))
        return self

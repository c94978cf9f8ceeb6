"""The base of methods that are finite differences until something is about to break."""

from dembound.methods.method import WIDEST, Method
from dembound.table import quantity


class Triggered(Method):
    """Local springs until a stretch reaches `trigger` of the critical one, peridynamics of some kind from then on."""

    horizon: int = quantity(
        ..., unit="1", means="count", help="horizon m in spacings, at most half of those in the bar", ge=1, le=WIDEST
    )
    trigger: float = quantity(
        0.9, unit="1", means="share", help="share of the critical stretch at which peridynamics begins", gt=0.0, le=1.0
    )

    @property
    def largest_horizon(self) -> int:
        """The horizon m."""
        return self.horizon

"""A driven side: the velocity of its particles is prescribed."""

from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.driven import Driven
from dembound.boundaries.fixed import Fixed
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves


class Velocity(Driven):
    """A rigid grip that moves with the given waves; the component without a wave is held, rotation is free."""

    for_bars: ClassVar[bool] = True

    type: Literal["velocity"]

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """Both axes."""
        return (0, 1)

    def at_rest(self) -> Boundary:
        """A rigid wall."""
        return Fixed(type="fixed")

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe v = wave(t) along each named direction and v = 0 along the other."""
        for component, name in enumerate(self.waves_by_axis(edge.axis)):
            supports.add(
                edge.nodes,
                component,
                drive=1.0 if name else 0.0,
                signal=waves[name].velocity if name else None,
                prescribed=True,
            )

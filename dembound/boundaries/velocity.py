"""A driven side: the velocity of its particles is prescribed."""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.driven import Driven
from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder


class Velocity(Driven):
    """A rigid grip that moves with the waves named; the component without a wave is held, rotation is free."""

    type: Literal["velocity"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Prescribe v = wave(t) along each named direction and v = 0 along the other."""
        for component, name in enumerate(self.waves_by_axis(edge.axis)):
            supports.add(
                edge.nodes,
                component,
                drive=1.0 if name else 0.0,
                signal=waves[name].velocity if name else None,
                prescribed=True,
            )

"""A fixed side: its particles neither move nor turn."""

from collections.abc import Mapping
from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder


class Fixed(Boundary):
    """A rigid wall the edge particles are glued to; an arriving wave is reflected with its sign turned."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True

    type: Literal["fixed"]

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """All three components."""
        return (0, 1, 2)

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Prescribe zero velocity for all three components."""
        for component in range(3):
            supports.add(edge.nodes, component, prescribed=True)

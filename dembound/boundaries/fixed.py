"""A fixed side: its particles neither move nor turn."""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder
from dembound.table import Table


class Fixed(Table):
    """A rigid wall the edge particles are glued to; an arriving wave is reflected with its sign turned."""

    type: Literal["fixed"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Prescribe zero velocity for all three components."""
        for component in range(3):
            supports.add(edge.nodes, component, prescribed=True)

"""A roller: the side slides along itself, but neither leaves its plane nor enters it."""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder
from dembound.table import Table


class Roller(Table):
    """A smooth rigid wall: no motion along the side's normal; sliding and turning are free."""

    type: Literal["roller"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Prescribe zero velocity along the normal."""
        supports.add(edge.nodes, edge.axis, prescribed=True)

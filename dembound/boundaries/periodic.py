"""A periodic side: the scene goes on with its own opposite side. Sides come in pairs."""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder
from dembound.table import Table


class Periodic(Table):
    """Bonds run on across the seam; the tiling makes them, no support is needed."""

    type: Literal["periodic"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Add nothing: the seam bonds already hold the side."""

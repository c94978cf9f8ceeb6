"""A free side: nothing pushes. It is also what a side without a table is."""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder
from dembound.table import Table


class Free(Table):
    """No support; an arriving wave is reflected with the motion doubled."""

    type: Literal["free"] = "free"

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """Add nothing."""

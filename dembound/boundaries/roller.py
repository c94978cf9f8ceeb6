"""A roller: the particles of the side move along it, but not along its normal."""

from typing import ClassVar, Literal

from dembound.boundaries.platen import Wall
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves


class Roller(Wall):
    """A smooth rigid wall: no motion along the side's normal; sliding and turning are free."""

    for_static: ClassVar[bool] = True

    type: Literal["roller"]

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """The motion along the normal."""
        return (normal_axis,)

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe zero velocity along the normal."""
        supports.add(self.part_of(edge).nodes, edge.axis, prescribed=True)

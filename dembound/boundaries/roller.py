"""A roller: the particles of the side move along it, but not along its normal."""

from typing import ClassVar, Literal

from dembound.boundaries.platen import Holding
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.table import quantity


class Roller(Holding):
    """A smooth rigid wall: no motion along the side's normal; sliding and turning are free."""

    for_static: ClassVar[bool] = True

    type: Literal["roller"]

    artificial: bool = quantity(True, unit="1", help="whether ground or rock goes on beyond the side")

    @property
    def is_artificial(self) -> bool:
        """The value of the key ``artificial``."""
        return self.artificial

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """The motion along the normal."""
        return (normal_axis,)

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe zero velocity along the normal."""
        supports.add(self.part_of(edge).nodes, edge.axis, prescribed=True)

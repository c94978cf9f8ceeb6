"""A fixed side: its particles neither move nor turn."""

from typing import ClassVar, Literal

from dembound.boundaries.platen import Holding
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.table import quantity


class Fixed(Holding):
    """A rigid wall: its particles neither move nor turn; reflected velocities have the opposite sign."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True

    type: Literal["fixed"]

    artificial: bool = quantity(True, unit="1", help="whether ground or rock goes on beyond the side")

    @property
    def is_artificial(self) -> bool:
        """The value of the key ``artificial``."""
        return self.artificial

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """All three components."""
        return (0, 1, 2)

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe zero velocity."""
        for component in range(3):
            supports.add(self.part_of(edge).nodes, component, prescribed=True)

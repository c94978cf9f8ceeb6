"""A fixed side: its particles neither move nor turn."""

from typing import ClassVar, Literal

from dembound.boundaries.platen import Wall
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves


class Fixed(Wall):
    """A rigid wall: its particles neither move nor turn; reflected velocities have the opposite sign."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True

    type: Literal["fixed"]

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """All three components."""
        return (0, 1, 2)

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe zero velocity."""
        for component in range(3):
            supports.add(self.part_of(edge).nodes, component, prescribed=True)

"""A free-field side: the ground beyond it moves as it would without the body.

Z eq. 21. The force and moment of the ground on a particle are those that act on its twin in the free-field column
across the same seam. They include the static and the dynamic part and need no calibration (see packings/column.py).
Dashpots on the velocity relative to the twin absorb the waves from the body.
"""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.edge import normal_axis
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.boundaries.viscous import BearingDashpots, Viscous


class FreeField(BearingDashpots):
    """Continues as ground without the body: F = F_ff − βρcD·(v − v_ff) (Z eq. 21); left and right only.

    F_ff is the seam force of the free-field column, v_ff the velocity of the particle's twin in it.
    """

    may_halve: ClassVar[bool] = False
    needs_column: ClassVar[bool] = True
    beyond_dashpots: ClassVar[str] = "free-field sides without their column"

    type: Literal["free_field"]

    def mistakes(self) -> Iterator[str]:
        """What a side with a column cannot have."""
        yield from super().mistakes()
        if self.half_mass:
            yield "half_mass: is not allowed on a free-field side, whose other half is in the column"
        if self.rock is not None:
            yield "rock: is not allowed on a free-field side, whose column is of the same ground"

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """A side that cannot have a column."""
        yield from super().problems(side, tables)
        if normal_axis(side) == 1:
            yield (
                f'boundary.{side}.type: "{self.type}" is for left and right; '
                "its column is vertical and as high as the body"
            )

    def dashpots_alone(self) -> Viscous:
        """The viscous side with the same dashpots."""
        return Viscous(type="viscous", beta_p=self.beta_p, beta_s=self.beta_s)

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """One dashpot per edge particle and direction, on its velocity relative to its twin."""
        for component, damping in enumerate(self.dampings(edge, medium)):
            supports.add(edge.nodes, component, damping=damping, follow=damping)

"""A driven side: the velocity of its particles is prescribed."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.boundary import Boundary, Driven
from dembound.boundaries.edge import Motion
from dembound.boundaries.fixed import Fixed
from dembound.boundaries.platen import Holding
from dembound.boundaries.roller import Roller
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.table import quantity

Component = Literal["normal", "shear"]
"""Component of the motion of a side: along its normal, or across it."""

MOTIONS: Mapping[Component, Motion] = {"normal": "p", "shear": "s"}
"""Component -> the waves that move the side along it."""


class Velocity(Holding, Driven):
    """A rigid platen that moves with the given waves.

    A held component without a wave does not move; one that is not held is free, and so is rotation: by default a grip,
    with "normal" alone a smooth platen.
    """

    for_bars: ClassVar[bool] = True

    type: Literal["velocity"]

    hold: tuple[Component, ...] = quantity(("normal", "shear"), min_length=1)
    """components of motion that it prescribes; others are free"""

    def mistakes(self) -> Iterator[str]:
        """Waves of components that it does not hold."""
        yield from super().mistakes()
        for part, motion in MOTIONS.items():
            if part not in self.hold and motion in self.waves:
                yield f"wave_{motion}: moves a component that hold does not name; add it there"

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Components of an end of a bar."""
        yield from super().problems(side, tables)
        if "bar" in tables and "hold" in self.model_fields_set:
            yield f"boundary.{side}.hold: is for sides of disks; a bar moves only along its axis"

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """The axes of the components that it holds."""
        axes = {"normal": normal_axis, "shear": 1 - normal_axis}
        return tuple(sorted({axes[component] for component in self.hold}))

    def at_rest(self) -> Boundary:
        """A rigid wall, or a smooth one."""
        if set(self.hold) == set(MOTIONS):
            return Fixed(type="fixed", within=self.within)
        return Roller(type="roller", within=self.within) if "normal" in self.hold else super().at_rest()

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Prescribe v = wave(t) along each named direction and v = 0 along others that are held."""
        nodes, held = self.part_of(edge).nodes, self.prescribed(edge.axis)
        for component, name in enumerate(self.waves_by_axis(edge.axis)):
            if component in held:
                supports.add(
                    nodes,
                    component,
                    drive=1.0 if name else 0.0,
                    signal=waves[name].velocity if name else None,
                    prescribed=True,
                )

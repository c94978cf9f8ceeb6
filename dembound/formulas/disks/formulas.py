"""Causes of the error of disks computed by formulas from the motion at the monitors, without further runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

from dembound.disks.scene import DiskScene
from dembound.formulas.cause import Cause
from dembound.formulas.disks.continuum import causes_of_continuum
from dembound.formulas.disks.dispersion import Dispersion
from dembound.formulas.disks.driven_sides import DrivenSides
from dembound.formulas.disks.held_sides import HeldSides
from dembound.formulas.disks.near_loads import causes_near_loads
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.single_disks import causes_at_edges, causes_at_surface
from dembound.formulas.disks.walls import causes_of_walls
from dembound.formulas.history import Motions


@dataclass(frozen=True)
class Formulas:
    """The formulas of one scene, which runs at a time step (s); reflections : of its sides."""

    scene: DiskScene
    time_step: float
    reflections: Reflections = field(default_factory=Reflections, repr=False)

    def causes(self, motions: Motions) -> list[Cause]:
        """All causes but absorbing sides without waves; motions : by monitor."""
        scene = self.scene
        return [
            *causes_of_continuum(scene, {name: own.place for name, own in motions.items()}),
            *DrivenSides(scene, self.time_step, self.held_sides, self.reflections).causes(motions),
            *self.dispersion.causes(motions),
            *causes_of_walls(scene, motions),
            *causes_near_loads(scene, motions),
            *causes_at_edges(scene, motions),
            *causes_at_surface(scene, motions),
            *self.held_sides.causes(motions),
        ]

    def without_motion(self, names: Sequence[str]) -> list[Cause]:
        """The causes that do not depend on the motion, at monitors of these names."""
        places = {name: self.scene.monitored[name] for name in names}
        return [*causes_of_continuum(self.scene, places), *causes_of_walls(self.scene, names)]

    @cached_property
    def held_sides(self) -> HeldSides:
        """Sides of the problem itself that hold disks."""
        return HeldSides(self.scene)

    @cached_property
    def dispersion(self) -> Dispersion:
        """Delays of waves by the disks and by the steps."""
        return Dispersion(self.scene, self.time_step)

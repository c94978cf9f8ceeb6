"""The base of wave-driven sides: the named waves and the directions in which they move the side."""

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import model_validator

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import Motion, axis_of_motion
from dembound.table import quantity


class Drivable(Boundary):
    """A side that may name waves by type: P moves along the side's normal, S across it.

    Positive velocities point along +x and +y on every side. Both waves may be given together.
    """

    wave_p: str | None = quantity(None, unit="1", help="name of the wave that moves along the side's normal")
    wave_s: str | None = quantity(None, unit="1", help="name of the wave that moves across the side's normal")

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Waves along a direction in which nothing can move."""
        yield from super().problems(side, tables)
        held = tables["motion"].held if tables.get("motion") else ()
        for motion in self.waves:
            if (direction := "xy"[axis_of_motion(side, motion)]) in held:
                yield f"boundary.{side}.wave_{motion}: drives {direction}, which motion.held holds for every particle"

    @property
    def waves(self) -> Mapping[Motion, str]:
        """The waves that are given."""
        named: dict[Motion, str | None] = {"p": self.wave_p, "s": self.wave_s}
        return {motion: name for motion, name in named.items() if name is not None}


class Driven(Drivable):
    """A side that needs at least one wave."""

    @model_validator(mode="after")
    def _names_a_wave(self) -> "Driven":
        if self.wave_p is None and self.wave_s is None:
            raise ValueError("names no wave; give wave_p (along the normal), wave_s (across it) or both")
        return self

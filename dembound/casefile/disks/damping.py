"""The ``[damping]`` table."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import model_validator

from dembound.table import Table, quantity

LEAST_RATIO = 1.5
"""Least ratio of the highest to the lowest frequency of a band."""


class Damping(Table):
    """How `material.quality_factor` damps: Q is nearly constant over a band of frequencies, the same for P and S.

    The stiffness of damped ground grows with the frequency, so that wave speeds hold at one frequency.
    """

    type: Literal["quality", "rayleigh"] = quantity(
        "quality",
        unit="1",
        help='"quality": nearly constant Q; "rayleigh": drag αm and βdF/dt, with ξ = 1/(2Q) at both ends of the band',
    )
    band: tuple[float, float] | None = quantity(
        None,
        unit="Hz",
        help="lowest and highest frequency of nearly constant Q; absent: that of the waves, or 0.3 to 10 Hz",
    )
    frequency: float | None = quantity(
        None,
        unit="Hz",
        help="frequency at which the wave speeds and moduli hold; absent: the geometric mean of the band",
        gt=0.0,
    )
    mechanisms: int = quantity(
        3, unit="1", means="count", help="relaxation mechanisms; 3 keep 1/Q within 1 % over 0.3 to 10 Hz", ge=2, le=6
    )

    @model_validator(mode="after")
    def _ascending(self) -> "Damping":
        if self.band is not None and not 0.0 < LEAST_RATIO * self.band[0] <= self.band[1]:
            low, high = self.band
            raise ValueError(
                f"band: is [{low:g}, {high:g}], must be two frequencies above 0, the second at least {LEAST_RATIO:g} "
                "times the first"
            )
        return self

    @model_validator(mode="after")
    def _only_of_mechanisms(self) -> "Damping":
        if self.type == "rayleigh":
            given = [key for key in ("frequency", "mechanisms") if key in self.model_fields_set]
            if given:
                raise ValueError("\n".join(f'{key}: is only allowed with type = "quality"' for key in given))
        return self

    @property
    def memories(self) -> int:
        """Number of memories of each force."""
        return 2 if self.type == "rayleigh" else self.mechanisms


def qualities(tables: Mapping[str, Any]) -> set[float | None]:
    """The quality factors of all layers, None for undamped ones; an invalid table is None."""
    own = tables["material"] and tables["material"].quality_factor
    layers = [layer for layer in tables["layer"] if layer is not None]
    return {own if layer.quality_factor is None else layer.quality_factor for layer in layers} or {own}


def is_damped(tables: Mapping[str, Any]) -> bool:
    """Whether the ground, or a layer of it, has a quality factor; an invalid table is None."""
    return qualities(tables) != {None}


def damping_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """A table [damping] that changes nothing, or Rayleigh damping of ground that goes on as a continuum."""
    if tables["damping"].model_fields_set and not is_damped(tables):
        yield "damping: is of no use without material.quality_factor"
    beyond = [side for side, table in tables["boundary"].items() if table and table.is_outside]
    if tables["damping"].type == "rayleigh" and beyond:
        yield (
            f'damping.type: is "rayleigh", which ground beyond boundary.{beyond[0]} cannot have; take sides of type '
            '"viscous", "viscoelastic" or "free_field", or damping.type = "quality"'
        )

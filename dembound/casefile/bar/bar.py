"""The ``[bar]`` table: a straight bar that moves along its axis, and its material."""

import math
from collections.abc import Iterator

from pydantic import model_validator

from dembound.table import LARGEST, SMALLEST, Table, quantity

PAIRS = (("section", "diameter"), ("wave_speed", "youngs_modulus"), ("strength", "critical_stretch"))
"""Pairs of keys of which a bar may have only one."""

MOST_CELLS = 2_000_000
"""Largest number of cells: more is a mistake, and computing the stability limit alone would take minutes."""


class Bar(Table):
    """Length, section and material of a bar, and the spacing of its nodes.

    Nodes are at x = 0, Δx, … L; the two at the ends have half a volume. The section is given by its area or by the
    diameter of a round bar, the stiffness by wave speed c = √(E/ρ) or Young's modulus E, the strength by the stress or
    the stretch at which a bond breaks, s₀ = σ_t/E. Without a strength nothing breaks.
    """

    length: float = quantity(..., unit="m", help="length L of the bar", gt=0.0)
    spacing: float = quantity(..., unit="m", help="distance Δx from node to node; a whole number of them is L", gt=0.0)
    section: float | None = quantity(None, unit="m²", help="area of the cross-section; 1 m² if not given", gt=0.0)
    diameter: float | None = quantity(None, unit="m", help="diameter of a round bar", gt=0.0)
    density: float = quantity(..., unit="kg/m³", help="density ρ", gt=0.0)
    wave_speed: float | None = quantity(None, unit="m/s", help="speed c of waves along the bar", gt=0.0)
    youngs_modulus: float | None = quantity(None, unit="Pa", help="Young's modulus E", gt=0.0)
    strength: float | None = quantity(None, unit="Pa", help="tensile strength σ_t; absent: unbreakable", gt=0.0)
    critical_stretch: float | None = quantity(None, unit="1", help="stretch s₀ at which a bond breaks", gt=0.0)
    attenuation: float = quantity(
        0.0, unit="1/m", help="α: high frequencies fade by exp(−αx) over a distance x (L eq. 19)", ge=0.0
    )

    @model_validator(mode="after")
    def _consistent(self) -> "Bar":
        problems = [
            f"{second}: is not allowed together with {first}"
            for first, second in PAIRS
            if getattr(self, first) is not None and getattr(self, second) is not None
        ]
        problems += [*self._problems_with_stiffness(), *self._problems_with_spacing()]
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def _problems_with_stiffness(self) -> Iterator[str]:
        """No stiffness, or one outside the range of numbers."""
        key = "youngs_modulus" if self.wave_speed is None else "wave_speed"
        if self.wave_speed is None and self.youngs_modulus is None:
            yield "wave_speed: is missing; give either wave_speed or youngs_modulus"
        elif not SMALLEST < self.modulus < LARGEST or not SMALLEST < self.modulus / self.density < LARGEST:
            yield f"{key}: is {getattr(self, key):g}, with density {self.density:g} beyond any material"

    def _problems_with_spacing(self) -> Iterator[str]:
        """Spacings that do not fit into the length, or too many of them."""
        cells = self.length / self.spacing
        if cells > MOST_CELLS:
            yield f"spacing: is {self.spacing:g}, must cut bar.length, {self.length:g} m, into {MOST_CELLS:,} or less"
        elif cells < 1.5 or abs(cells - round(cells)) > 1e-6 * cells:
            yield (
                f"spacing: is {self.spacing:g}, must divide bar.length, {self.length:g} m, into two or more equal parts"
            )

    @property
    def cells(self) -> int:
        """Number of spacings in the length; the number of nodes is larger by one."""
        return round(self.length / self.spacing)

    @property
    def area(self) -> float:
        """Area A of the cross-section, m²."""
        if self.diameter is not None:
            return 0.25 * math.pi * self.diameter**2
        return 1.0 if self.section is None else self.section

    @property
    def modulus(self) -> float:
        """Young's modulus E in Pa."""
        if self.youngs_modulus is not None:
            return self.youngs_modulus
        assert self.wave_speed is not None
        return self.density * (self.wave_speed * self.wave_speed)  # ** would raise where it overflows

    @property
    def speed(self) -> float:
        """Wave speed c in m/s."""
        return math.sqrt(self.modulus / self.density)

    @property
    def drag_rate(self) -> float:
        """Rate 2αc (1/s) of the dashpots that attenuate, as parts of the masses (L eq. 19 as u_tt + 2αc u_t)."""
        return 2.0 * self.attenuation * self.speed

    @property
    def breaking_stretch(self) -> float:
        """Stretch s₀ at which bonds break; infinite for an unbreakable bar."""
        if self.critical_stretch is not None:
            return self.critical_stretch
        return math.inf if self.strength is None else self.strength / self.modulus

"""The ``[[bar.range]]`` tables: uniform parts of a bar."""

from typing import Literal

from pydantic import model_validator

from dembound.table import FileName, Table, quantity


class BarRange(Table):
    """A part of a bar with its own length, spacing and material; keys that are left out have the value in `[bar]`.

    At an interface the range is bonded to the one on its left, or both only touch: a contact pushes, and opens where it
    would have to pull.
    """

    name: FileName = quantity(..., unit="1", help="name of the range in messages and results")
    length: float = quantity(..., unit="m", means="length", help="length of the range", gt=0.0)
    spacing: float | None = quantity(
        None,
        unit="m",
        means="length",
        help="distance of its nodes; its length is a whole number of them, two or more",
        gt=0.0,
    )
    section: float | None = quantity(None, unit="m²", help="area of its cross-section", gt=0.0)
    diameter: float | None = quantity(
        None, unit="m", means="thickness", help="diameter of a round range, instead of section", gt=0.0
    )
    density: float | None = quantity(None, unit="kg/m³", help="density ρ", gt=0.0)
    wave_speed: float | None = quantity(None, unit="m/s", means="wave speed", help="speed c of its waves", gt=0.0)
    youngs_modulus: float | None = quantity(
        None, unit="Pa", means="modulus", help="Young's modulus E, instead of wave_speed", gt=0.0
    )
    strength: float | None = quantity(None, unit="Pa", means="strength", help="tensile strength σ_t", gt=0.0)
    critical_stretch: float | None = quantity(
        None, unit="1", means="strain", help="stretch s₀ at which a bond breaks, instead of strength", gt=0.0
    )
    fracture_energy: float | None = quantity(None, unit="J/m²", help="fracture energy G_f of its cracks", gt=0.0)
    strength_per_decade: float | None = quantity(
        None, unit="Pa", means="strength", help="rise of its strength for a tenfold strain rate", gt=0.0
    )
    strength_rates: tuple[float, float] | None = quantity(
        None, unit="1/s", help="strain rates [slowest, fastest] between which the strength rises"
    )
    attenuation: float | None = quantity(None, unit="1/m", help="α of its attenuation", ge=0.0)
    velocity: float = quantity(
        0.0,
        unit="m/s",
        means="velocity",
        help="velocity of the whole range at the start, positive to the right, as of a striker",
    )
    interface: Literal["bonded", "contact"] = quantity(
        "bonded", unit="1", help="interface with the range on its left; a contact bears no tension"
    )
    gap: float = quantity(0.0, unit="m", means="gap", help="opening of the contact on its left at the start", ge=0.0)

    @model_validator(mode="after")
    def _gap_of_contact(self) -> "BarRange":
        if self.gap > 0.0 and self.interface != "contact":
            raise ValueError('gap: is only allowed with interface = "contact"')
        return self

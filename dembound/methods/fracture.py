"""Fracture of the bonds of a bar: at once, or with a fracture energy; strength that rises with the strain rate."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fracture:
    """Fracture energy J/m², 0 for bonds that break at once, and rate dependence of the strength.

    per_decade : Pa by which the strength rises for a tenfold strain rate, between the two rates (1/s).
    """

    energy: float = 0.0
    per_decade: float = 0.0
    rates: tuple[float, float] = (1.0, 1.0)

    def opening(self, strength: float) -> float:
        """Opening w_c = 2G_f/σ_t (m) at which a crack bears no stress, for a strength in Pa."""
        return 2.0 * self.energy / strength


AT_ONCE = Fracture()
"""Bonds that break at once."""

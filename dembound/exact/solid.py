"""An isotropic elastic solid in plane strain."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Solid:
    """Density ρ (kg/m³) and the speeds c_p and c_s (m/s) of P and S waves.

    Raises ValueError unless ρ > 0 and 0 < c_s < c_p, so that every plane strain takes work.
    """

    density: float
    p_wave_speed: float
    s_wave_speed: float

    def __post_init__(self) -> None:
        if self.density <= 0.0:
            raise ValueError(f"density ({self.density} kg/m³) must be positive")
        if not 0.0 < self.s_wave_speed < self.p_wave_speed:
            raise ValueError(f"speeds must be 0 < S ({self.s_wave_speed} m/s) < P ({self.p_wave_speed} m/s)")

    @property
    def shear(self) -> float:
        """Shear modulus μ = ρc_s², Pa."""
        return self.density * self.s_wave_speed**2

    @property
    def uniaxial(self) -> float:
        """Modulus λ + 2μ = ρc_p² of uniaxial strain, Pa."""
        return self.density * self.p_wave_speed**2

    @property
    def lame(self) -> float:
        """Lamé's constant λ, Pa."""
        return self.uniaxial - 2.0 * self.shear

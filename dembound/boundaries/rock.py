"""Other rock beyond a side with dashpots: a half-space on which the ground stands."""

from pydantic import model_validator

from dembound.boundaries.edge import BoundaryMedium, Edge
from dembound.boundaries.sides import Motion
from dembound.table import Table, quantity


class Rock(Table):
    """The rock of a half-space, whose dashpots ρ_r c_r replace those of the ground; right at normal incidence."""

    density: float = quantity(..., unit="kg/m³", help="density ρ of the rock", gt=0.0)
    p_wave_speed: float = quantity(..., unit="m/s", means="wave speed", help="speed of its P waves", gt=0.0)
    s_wave_speed: float = quantity(..., unit="m/s", means="wave speed", help="speed of its S waves", gt=0.0)

    @model_validator(mode="after")
    def _is_stable(self) -> "Rock":
        if not self.s_wave_speed < self.p_wave_speed:
            raise ValueError("s_wave_speed: must be below p_wave_speed, as in every elastic solid")
        return self

    def factors(self, edge: Edge, medium: BoundaryMedium) -> dict[Motion, float]:
        """β = ρ_r c_r/(ρc)·H/ΣD of an edge, with ρ and c of the medium; 1 where it has no such waves."""
        pairs = ((self.p_wave_speed, medium.p_wave_speed), (self.s_wave_speed, medium.s_wave_speed))
        times = self.density / medium.density / edge.diameter_sum_ratio
        p, s = (times * own / given if given > 0.0 else 1.0 for own, given in pairs)
        return {"p": p, "s": s}

    @property
    def shear_modulus(self) -> float:
        """G = ρc_s² in Pa."""
        return self.density * self.s_wave_speed**2

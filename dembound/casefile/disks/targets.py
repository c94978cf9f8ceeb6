"""Elastic constants asked of a body."""

from typing import NamedTuple

PAIRS = (("young", "poisson"), ("bulk", "shear"), ("p_wave_speed", "s_wave_speed"))
"""Keys of [material] that are targets of the body if both are given."""


class PlaneModuli(NamedTuple):
    """Moduli (Pa) of an isotropic body that deforms in its plane: bulk K = (C11 + C12)/2 and shear G = C66.

    The same body is a solid in plane strain or a sheet that is free across its plane, with other constants.
    """

    bulk: float
    shear: float

    @property
    def uniaxial(self) -> float:
        """Modulus ρc_p² (Pa) of P waves."""
        return self.bulk + self.shear

    def poisson(self, plane: str) -> float:
        """Poisson's ratio of the solid ("strain") or of the sheet ("stress")."""
        return (self.bulk - self.shear) / (2.0 * self.bulk if plane == "strain" else self.bulk + self.shear)

    def young(self, plane: str) -> float:
        """Young's modulus (Pa) of the solid ("strain") or of the sheet ("stress"), slope of a test of the sample."""
        return 2.0 * self.shear * (1.0 + self.poisson(plane))

    def compression(self, plane: str) -> float:
        """Bulk modulus (Pa) of the solid ("strain"), in three dimensions, or of the sheet ("stress")."""
        return self.bulk - self.shear / 3.0 if plane == "strain" else self.bulk

    @classmethod
    def of_young(cls, young: float, poisson: float, plane: str) -> "PlaneModuli":
        """From Young's modulus (Pa) and Poisson's ratio of the solid or the sheet."""
        shear = 0.5 * young / (1.0 + poisson)
        larger = 1.0 / (1.0 - 2.0 * poisson) if plane == "strain" else (1.0 + poisson) / (1.0 - poisson)
        return cls(larger * shear, shear)

    @classmethod
    def of_bulk(cls, bulk: float, shear: float, plane: str) -> "PlaneModuli":
        """From the bulk modulus (Pa) of the solid or the sheet, and the shear modulus (Pa)."""
        return cls(bulk + shear / 3.0 if plane == "strain" else bulk, shear)

    @classmethod
    def of_speeds(cls, density: float, p_wave_speed: float, s_wave_speed: float) -> "PlaneModuli":
        """From a density (kg/m³) and speeds (m/s)."""
        shear = density * s_wave_speed**2
        return cls(density * p_wave_speed**2 - shear, shear)


class Target(NamedTuple):
    """Moduli asked of a body.

    keys : that give them. along : "isotropic", of the nearest isotropic body; "x" or "y", of waves along it if speeds
    are given, else of a test of a sample with free sides along it. plane : meaning of the keys, "strain" or "stress".
    """

    keys: tuple[str, str]
    moduli: PlaneModuli
    along: str
    plane: str

    @property
    def by_waves(self) -> bool:
        """Whether wave speeds are asked for."""
        return self.keys == PAIRS[2]

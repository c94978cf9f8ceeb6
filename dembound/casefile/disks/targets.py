"""Elastic constants asked of a body, and the scatter of strengths."""

from typing import Literal, NamedTuple

from pydantic import model_validator

from dembound.table import LARGEST_WHOLE, Table, quantity

KEY_OF = {"normal": "deviation", "weibull": "shape"}
"""The key that each distribution needs."""


class Scatter(Table):
    """Scatter of the strengths of bonds: one factor for each, of mean 1, on both `pb_ten` and `pb_coh`.

    "normal" is cut off at three deviations either side, at most 0.95, and "weibull" below 0.05. The factor of a bond
    follows from `packing.seed` and its place in the packing.
    """

    type: Literal["normal", "weibull"] = quantity(..., unit="1", help="distribution of the factors")
    deviation: float | None = quantity(
        None, unit="1", means="share", help='standard deviation of "normal" before it is cut off', gt=0.0, le=1.0
    )
    shape: float | None = quantity(
        None, unit="1", means="setting", help='shape (Weibull modulus) of "weibull"', ge=1.0, le=1e3
    )
    seed: int = quantity(0, unit="1", means="count", help="other strengths of the same disks", ge=0, le=LARGEST_WHOLE)

    @property
    def in_words(self) -> str:
        """The distribution and its width."""
        width = {"normal": "± {:g}", "weibull": "modulus {:g}"}[self.type].format(getattr(self, KEY_OF[self.type]))
        return f"{self.type} {width}"

    @model_validator(mode="after")
    def _one_width(self) -> "Scatter":
        needed = KEY_OF[self.type]
        problems = [] if getattr(self, needed) is not None else [f'{needed}: is missing; type = "{self.type}" needs it']
        for key in KEY_OF.values():
            if key != needed and getattr(self, key) is not None:
                problems.append(f'{key}: is not allowed with type = "{self.type}"; give {needed}')
        if problems:
            raise ValueError("\n".join(problems))
        return self


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

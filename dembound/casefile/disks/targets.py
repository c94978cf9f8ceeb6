"""Keys of [material]: elastic constants asked of a body, the scatter of strengths, and what single laws add."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple

from dembound.casefile.types import LAWS
from dembound.table import LARGEST_WHOLE, Table, quantity

KEY_OF = {"normal": "deviation", "weibull": "shape"}
"""The key that each distribution needs."""


class Scatter(Table):
    """Scatter of the strengths of bonds: one factor for each, of mean 1, on both `pb_ten` and `pb_coh`.

    "normal" is cut off at three deviations either side, at most 0.95, and "weibull" below 0.05. The factor
    follows from `packing.seed` and the bond's place.
    """

    type: Literal["normal", "weibull"] = quantity()
    """distribution of the factors"""
    deviation: float | None = quantity(None, means="share", gt=0.0, le=1.0)
    """standard deviation of "normal" before it is cut off"""
    shape: float | None = quantity(None, means="setting", ge=1.0, le=1e3)
    """shape (Weibull modulus) of "weibull" """
    seed: int = quantity(0, means="count", ge=0, le=LARGEST_WHOLE)
    """other strengths of the same disks"""

    @property
    def in_words(self) -> str:
        """The distribution and its width."""
        width = {"normal": "± {:g}", "weibull": "modulus {:g}"}[self.type].format(getattr(self, KEY_OF[self.type]))
        return f"{self.type} {width}"

    def mistakes(self) -> Iterator[str]:
        """A width that is missing, or is that of the other distribution."""
        needed = KEY_OF[self.type]
        if getattr(self, needed) is None:
            yield f'{needed}: is missing; type = "{self.type}" needs it'
        for key in KEY_OF.values():
            if key != needed and getattr(self, key) is not None:
                yield f'{key}: is not allowed with type = "{self.type}"; give {needed}'


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


KEYS = {key.name: key for law in LAWS.values() for key in law.keys}
"""Keys that single laws add, by name."""

FIELDS: dict[str, Any] = {
    key.name: (float | None, quantity(None, unit=key.unit, means=key.means, help=key.help, **key.limits))
    for key in KEYS.values()
}
"""The same as fields of a table."""


def with_history() -> str:
    """The history-dependent laws that start elastic, for messages."""
    return " or ".join(f'"{name}"' for name, law in LAWS.items() if law.has_history and law.starts_elastic)


def keys_problems(material: Table, law_name: str, stiff: tuple[str, ...]) -> Iterator[str]:
    """Keys of a material that belong to another law, that its law lacks, or that it has no use for.

    stiff : keys from which the stiffness follows under laws without keys of their own.
    """
    law, own = LAWS[law_name], [key.name for key in LAWS[law_name].keys]
    for name, other in LAWS.items():
        for key in other.keys:
            if key.name in material.model_fields_set and key.name not in own:
                yield f'{key.name}: is only allowed with law = "{name}"'
    for name in own:
        if getattr(material, name) is None:
            yield f'{name}: is missing; law = "{law_name}" needs {" and ".join(own)}'
    if law.uses is not None:
        for name in type(material).model_fields:
            if name in material.model_fields_set - {*law.uses, *KEYS}:
                why = f"whose stiffness follows from {' and '.join(own)}" if name in stiff else "which does not use it"
                yield f'{name}: is not allowed with law = "{law_name}", {why}'


def law_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """What a law that does not start elastic does not go with: it has no stiffness without a stress at rest.

    tables : of the case by name; None for an invalid one.
    """
    material, static = tables["material"], tables["static"]
    if not material or LAWS[material.law].starts_elastic:
        return
    given = f'material.law is "{material.law}"'
    if tables["layer"]:
        yield f"layer: {given}, which is for uniform ground; layers need a law that starts elastic, as {with_history()}"
    if static and static.k0 is not None:
        yield f"static.k0: {given}, whose stiffness would change with depth; give static.stress, the same everywhere"
    is_pressed = static and static.stress and any(static.stress)
    for side, table in tables["boundary"].items():
        if not table:
            continue
        if table.is_outside:
            yield f'boundary.{side}.type: is "outside", but {given}; "viscous" or "free_field" absorb its waves'
        elif not is_pressed and (table.factors or table.needs_column or table.waves):
            yield (
                f"boundary.{side}: needs wave speeds, but {given}, whose contacts have no stiffness without pressure; "
                "give static.stress"
            )

"""The physical meanings of numbers in case files: likely sizes, and probable mistakes for unlikely ones.

Every number of a table has a meaning (`table.quantity`). Numbers are compared with the likely sizes of their meaning
before a run; a meaning of any size gives the reason.

Sources of the sizes: Mavko, Mukerji & Dvorkin, The Rock Physics Handbook (2009), for soils and rocks; Ashby, Materials
Selection in Mechanical Design (2011), for metals and plastics.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from dembound.words import percent


class Slip(NamedTuple):
    """A usual mistake: a value in another unit, or of another quantity.

    what : in words, after "likely". mend : from the given value to the correct one.
    """

    what: str
    mend: Callable[[float], float]


@dataclass(frozen=True)
class Meaning:
    """The likely sizes of numbers with one meaning.

    Attributes
    ----------
    why : the reason for the sizes; for a meaning without sizes, the reason why there are none.
    low, high : sizes below and above which a number other than 0 is unlikely; whose : things of such sizes, in words.
    usual : sizes within which a corrected value must be to be offered.
    slips : the usual mistakes. spared : likely sizes outside the limits.
    """

    why: str
    low: float = 0.0
    high: float = math.inf
    whose: str = ""
    usual: tuple[float, float] = (0.0, math.inf)
    slips: tuple[Slip, ...] = ()
    spared: frozenset[float] = frozenset()

    @property
    def is_free(self) -> bool:
        """Whether every size is likely."""
        return self.low == 0.0 and self.high == math.inf

    def doubt(self, value: float, unit: str, *, given: bool = True) -> str | None:
        """Reason why a value is unlikely, in words, with a correction if it was given; None for a likely value.

        given : False for values derived from others.
        """
        size = abs(value)
        if size == 0.0 or self.low <= size <= self.high or size in self.spared:
            return None
        of = "" if unit == "1" else f" {unit}"
        limits = f"{self.low:,.12g} to {self.high:,.12g}" if self.high >= 1.0 else f"{self.low:g} to {self.high:g}"
        says = f"is {value:g}{of}, where {self.whose} {limits if max(self.high, 1 / self.low) < 1e7 else self._short}"
        found = [f"{slip.what}: write {mended:.4g}" for slip, mended in self._mended(value)]
        if not given:
            return says
        return f"{says}; likely {' or '.join(found)}" if found else f"{says}; is it in {unit}?" if of else says

    @property
    def _short(self) -> str:
        """The limits as powers of ten."""
        return f"{self.low:g} to {self.high:g}"

    def _mended(self, value: float) -> Iterator[tuple[Slip, float]]:
        """The slips that explain a value, with the corrected values, which are usual."""
        for slip in self.slips:
            if self.usual[0] <= abs(mended := slip.mend(value)) <= self.usual[1]:
                yield slip, mended


def _free(why: str) -> Meaning:
    return Meaning(why)


def _times(factor: float, unit: str) -> Slip:
    """A value in another unit."""
    return Slip(f"in {unit}", lambda value: factor * value)


_PRESSURES = (_times(1e6, "MPa"), _times(1e9, "GPa"), _times(1e3, "kPa"))
_LENGTHS = (_times(1e-3, "mm"), _times(1e-2, "cm"))
_FROM_TANGENT = Slip("the friction coefficient tan φ", lambda value: math.degrees(math.atan(value)))
_RADIANS = Slip("in radians", math.degrees)

GRAVITY = 9.81
"""Acceleration of gravity, m/s²."""

MEANINGS: dict[str, Meaning] = {
    "density": Meaning(
        "from fresh snow to osmium",
        *(100.0, 23_000.0, "soils, rocks and metals have", (800.0, 9_000.0)),
        slips=(
            _times(1e3, "g/cm³ or t/m³"),
            _times(1e3 / GRAVITY, "kN/m³, a weight"),
            _times(1.0 / GRAVITY, "N/m³, a weight"),
            _times(1e12, "t/mm³"),
        ),
    ),
    "wave speed": Meaning(
        "from S waves in mud to P waves in diamond",
        *(10.0, 19_000.0, "soils, rocks and metals have", (60.0, 9_000.0)),
        slips=(_times(1e3, "km/s"), _times(1e-3, "mm/s")),
    ),
    "modulus": Meaning(
        "from gelatine, 10 kPa, to diamond, 1.1 TPa",
        *(1e4, 2e12, "soils, rocks and metals have", (1e6, 1e12)),
        slips=(_times(1e9, "GPa"), _times(1e6, "MPa"), _times(1e3, "kPa")),
    ),
    "strength": Meaning(
        "from soft clay, 1 kPa, to whiskers of metals, 10 GPa",
        *(1e3, 2e10, "soils, rocks and metals have", (1e3, 2e9)),
        slips=_PRESSURES,
    ),
    "stiffness of a joint": Meaning(
        "from a gouge to a fresh fracture under high stress; Bandis, Lumsden & Barton (1983) measured 1e9 to 4e11",
        *(1e5, 1e14, "joints have", (1e7, 1e13)),
        slips=(_times(1e9, "GPa/m or MPa/mm"), _times(1e6, "MPa/m"), _times(1e3, "kPa/m")),
    ),
    "stress": Meaning(
        "from the weight of some centimetres of soil to the centre of the earth",
        *(100.0, 4e11, "soils and rocks carry", (1e3, 2e9)),
        slips=_PRESSURES,
    ),
    "stress to reach": Meaning(
        "as other stresses, but tension is positive",
        *(100.0, 4e11, "soils and rocks carry", (1e3, 2e9)),
        slips=_PRESSURES,
    ),
    "pressure of a load": Meaning(
        "as stresses; a load of 1 Pa is that of a wave that contains the pressures",
        *(100.0, 4e11, "loads have", (1e3, 2e10)),
        slips=_PRESSURES,
        spared=frozenset({1.0}),
    ),
    "friction coefficient": Meaning(
        "rock on rock has 0.3 to 1, rubber on concrete 1.2",
        *(1e-3, 2.0, "surfaces have", (0.05, 2.0)),
        slips=(Slip("the friction angle in degrees", lambda value: math.tan(math.radians(min(value, 89.0)))),),
    ),
    "friction angle": Meaning(
        "from clay to interlocked blocks; below 2° only as 0",
        *(2.0, 75.0, "soils and rocks have", (5.0, 65.0)),
        slips=(_RADIANS, _FROM_TANGENT),
    ),
    "direction": Meaning(
        "an angle of less than a quarter turn in radians is one of less than 1.6°, which hardly anybody means",
        *(1.6, 360.0, "directions have", (1.6, 360.0)),
        slips=(_RADIANS,),
        spared=frozenset({0.25, 0.5, 1.0, 1.5}),
    ),
    "size of a particle": Meaning(
        "from silt to a block of 20 m", *(1e-6, 20.0, "particles have", (1e-4, 10.0)), slips=_LENGTHS
    ),
    "thickness": Meaning("from a fibre to a pile", *(1e-5, 5.0, "bars have", (1e-4, 1.0)), slips=_LENGTHS),
    "gap": Meaning(
        "bars that are to touch within a run are closer",
        *(1e-9, 0.1, "gaps of bars have", (1e-7, 0.02)),
        slips=(_times(1e-3, "mm"), _times(1e-6, "µm")),
    ),
    "length": Meaning(
        "from a laboratory specimen to a basin", *(1e-6, 1e5, "scenes have", (1e-3, 1e4)), slips=(_times(1e-3, "mm"),)
    ),
    "cross-section": Meaning(
        "from a wire of 10 µm to a pier",
        *(1e-10, 20.0, "bars have", (1e-6, 1.0)),
        slips=(_times(1e-6, "mm²"), _times(1e-4, "cm²")),
    ),
    "frequency": Meaning(
        "from tides to ultrasound", *(1e-6, 1e10, "waves have", (0.01, 1e8)), slips=(_times(1e-3, "mHz"),)
    ),
    "period": Meaning("from ultrasound to tides", 1e-10, 1e6, "waves have"),
    "duration": Meaning("from a crack in glass to a day", 1e-10, 1e6, "runs and waves have"),
    "fracture energy": Meaning(
        "from glass, 1 J/m², to tough metals, 100 kJ/m²",
        *(1.0, 1e6, "rocks, concrete and metals have", (3.0, 2e5)),
        slips=(_times(1e3, "N/mm or kJ/m²"),),
    ),
    "strain": Meaning(
        "from soft rock to fibres; beyond, bonds are no longer linear",
        *(1e-7, 0.03, "solids break at", (1e-6, 0.02)),
        slips=(_times(1e-2, "%"), _times(1e-3, "‰"), _times(1e-6, "µm/m")),
    ),
    "strain rate": Meaning("from creep to a shock", 1e-12, 1e8, "solids have"),
    "attenuation": Meaning(
        "a wave is gone within a millimetre above, and not weakened within the earth below", *(1e-8, 1e3, "solids have")
    ),
    "acceleration": Meaning(
        "gravity on an asteroid to a blow", *(1e-4, 1e7, "bodies have", (1.0, 1e3)), slips=(_times(1e-3, "mm/s²"),)
    ),
    "normal over shear stiffness": Meaning(
        "1 to 4 gives Poisson's ratios of rocks; below 1 contacts are softer along their normal than across it",
        *(0.5, 20.0, "contacts have", (1.0, 20.0)),
        slips=(Slip("shear over normal stiffness", lambda value: 1.0 / value),),
    ),
    "bond radius": Meaning(
        "bonds as wide as the smaller disk have 1", *(0.02, 3.0, "bonds have", (0.05, 2.0)), slips=(_times(1e-2, "%"),)
    ),
    "rest": Meaning(
        "above, forces out of balance still move the body when the stage is over",
        *(1e-14, 0.01, "bodies at rest have", (1e-8, 0.01)),
        slips=(_times(1e-2, "%"),),
    ),
    "quality factor": Meaning("from soft soil to intact rock", 3.0, 2e3, "ground has"),
    "factor of springs": Meaning("0.5 to 2 in theory", 0.01, 20.0, "springs of a half-plane have"),
    "share": _free("its limits, from 0 to 1, are those of the key"),
    "Poisson's ratio": _free("its limits, from −1 to 0.5, are those of the key"),
    "place": _free("places are compared with the scene"),
    "velocity": _free("it is compared with that of waves: the strain is v/c"),
    "local damping": _free("it depends on whether waves run"),
    "force": _free("a force of 1 N may stand for any, as long as motion is linear; it is compared with a strength"),
    "factor": _free("of a wave or of a formula, any number is likely"),
    "factor of dashpots": _free("it is compared with the packing's own factors"),
    "Courant number": _free("it is compared with the stability limit"),
    "ratio of stresses": _free("its limits, from 0 to 5, are those of the key"),
    "ratio of radii": _free("its limits, from 1 to 4, are those of the key"),
    "setting": _free("of a method, in its own units; its limits are those of the key"),
    "wall time": _free("of the machine, not of the scene"),
    "count": _free("each has a largest number, with the reason beside it"),
}
"""Name -> meaning."""

FADED = 0.01
"""Least amplitude of a wave along a bar with attenuation, over its initial one."""


def fading(place: str, exponent: float, length: float) -> Iterator[str]:
    """Message about an attenuation, at a place, that leaves nothing of a wave.

    exponent : of the decay along the bar; length : of the bar, m.
    """
    if (left := math.exp(-exponent)) < FADED:
        yield (
            f"{place}: leaves {percent(left)} of a wave along the bar of {length:g} m; is it in 1/m? 1 dB/m is "
            "0.115 1/m"
        )


OF_UNITS = {
    "kg/m³": "density",
    "Hz": "frequency",
    "J/m²": "fracture energy",
    "m²": "cross-section",
    "1/s": "strain rate",
    "1/m": "attenuation",
    "m/s²": "acceleration",
    "N/m": "force",
    "s": "duration",
}
"""Units whose numbers have only one meaning, which need not be given."""

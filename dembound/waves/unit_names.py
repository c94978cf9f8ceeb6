"""Units as headers of files spell them: cm/s, cm/sec, cm s^-1, cm.s⁻¹ and "centimetres per second" are one.

A unit is read as a product of powers of named units.
"""

import re
from typing import NamedTuple

STANDARD_GRAVITY = 9.80665
"""m/s²; the weight of 1 kg in kgf."""


class Named(NamedTuple):
    """A unit as it was spelled, the quantity that it measures, and its size in SI (1 where that has no meaning)."""

    spelled: str
    quantity: str
    size: float


Powers = tuple[int, int, int]
"""Exponents of m, s and kg."""

QUANTITIES: dict[Powers, tuple[str, float]] = {
    (1, -1, 0): ("velocities", 1.0),
    (1, -2, 0): ("accelerations", 1.0),
    (1, 0, 0): ("displacements", 1.0),
    (0, 1, 0): ("times", 1.0),
    (-1, -2, 1): ("pressures", 1.0),
    (1, -2, 1): ("forces", 1.0),
    (0, 0, 1): ("forces", STANDARD_GRAVITY),  # "kg" and "kg/cm²" are those of weights
    (-2, 0, 1): ("pressures", STANDARD_GRAVITY),
}
"""Powers of m, s and kg -> quantity and size in SI."""


def _all(powers: Powers, **sizes: float) -> dict[str, tuple[float, Powers]]:
    """Names of units with their sizes and powers; synonyms are separated by _or_."""
    return {name: (size, powers) for names, size in sizes.items() for name in names.split("_or_")}


UNITS: dict[str, tuple[float, Powers]] = {
    **_all((1, 0, 0), m_or_metre_or_metres_or_meter_or_meters=1.0, km=1e3, nm=1e-9),
    **_all((1, 0, 0), cm_or_centimetre_or_centimetres_or_centimeter_or_centimeters=1e-2),
    **_all((1, 0, 0), mm_or_millimetre_or_millimetres_or_millimeter_or_millimeters=1e-3),
    **_all((1, 0, 0), um_or_micron_or_microns_or_micrometre_or_micrometer=1e-6),
    **_all((1, 0, 0), inch_or_inches=0.0254, ft_or_foot_or_feet=0.3048),
    "in": (0.0254, (1, 0, 0)),
    **_all((0, 1, 0), s_or_sec_or_secs_or_second_or_seconds=1.0, min_or_mins_or_minute_or_minutes=60.0),
    **_all((0, 1, 0), ms_or_msec_or_msecs_or_millisecond_or_milliseconds=1e-3, ns_or_nsec=1e-9),
    **_all((0, 1, 0), us_or_usec_or_microsecond_or_microseconds=1e-6, h_or_hr_or_hour_or_hours=3600.0),
    **_all((1, -1, 0), mps=1.0, kmps=1e3, cms_or_cmps_or_kine_or_kines=1e-2, mms_or_mmps=1e-3),
    **_all((1, -1, 0), kmh_or_kph=1.0 / 3.6, mph=0.44704, ips=0.0254, fps=0.3048),
    **_all((1, -1, 0), kt_or_kts_or_knot_or_knots=1852.0 / 3600.0),
    **_all((1, -2, 0), g=STANDARD_GRAVITY, mg=1e-3 * STANDARD_GRAVITY, gal_or_gals=1e-2, mgal=1e-5),
    **_all((0, 0, 1), kg=1.0, t_or_ton_or_tons_or_tonne_or_tonnes=1e3, lb_or_lbs=0.45359237),
    **_all((1, -2, 1), n_or_newton_or_newtons=1.0, kn=1e3, mn=1e6, dyn_or_dyne_or_dynes=1e-5),
    **_all((1, -2, 1), kgf_or_kp=STANDARD_GRAVITY, tf=1e3 * STANDARD_GRAVITY, lbf=4.4482216, kip_or_kips=4448.2216),
    **_all((-1, -2, 1), pa=1.0, hpa_or_mbar=100.0, kpa=1e3, mpa=1e6, gpa=1e9, bar_or_bars=1e5, kbar=1e8),
    **_all((-1, -2, 1), psi=6894.757, ksi=6894757.0, atm=101325.0),
}
"""Name in lower case -> size in SI and powers."""

OTHERS = {
    **dict.fromkeys(("v", "mv", "uv", "kv", "volt", "volts"), "voltages"),
    **dict.fromkeys(("count", "counts", "cts", "digits", "lsb"), "counts"),
    **dict.fromkeys(("strain", "ue", "uε", "ustrain", "microstrain", "ε", "um/m", "m/m"), "strains"),
}
"""Names of units of quantities that cases do not have -> the quantity."""

CLEAR = frozenset(re.findall(r"\S+", "kpa mpa gpa kbar psi ksi kine kines knots kmh kph mph ips fps gal gals kgf dyn "))
"""Units of one word that cannot be anything else."""

COMPONENTS = frozenset(("NS", "EW", "UD", "N-S", "E-W", "U-D"))
"""Directions of components; "ns" are nanoseconds."""

NO_UNITS = frozenset(re.findall(r"\S+", "x y z n e w ns ew ud n-s e-w u-d h1 h2 v h r t - 1 2d 3d dimensionless none "))
"""Texts in brackets that are directions of a component, or say that values have no unit."""

_SIGNS = str.maketrans("⁰¹²³⁴⁻−μµ·⋅×*", "01234--uu    ")
_FACTOR = re.compile(r"\s*(/?)\s*([a-zε]+)\s?\^?(-?\d)?")
_PARTS = re.compile(r"g ?/ ?(10+)")
"""A decimal part of g: G/10 in volumes of uncorrected records."""

_SPLIT_POWER = re.compile(r"(\b[a-z]+)[ .]((?:s|sec|cm|mm|m)\^?-\d)", re.IGNORECASE)
_BRACKETS = re.compile(r"[\[(]\s*((?:[^\[\]()]|\([^()]*\))*?)\s*[\])]")
_SUFFIX = re.compile(r"(?<=[a-z0-9])_([a-zµμ²/^_]+?)(?=[\s,;:\"']|$)", re.IGNORECASE)


def unit_named(text: str, read: str = "") -> Named | None:
    """The unit named by a text, in any usual spelling; None for other texts.

    read : the unit in which values are read; "kn" means knots with m/s, else kilonewtons.
    """
    plain = _plain(text)
    if text.strip() in COMPONENTS:
        return None
    if plain in OTHERS:
        return Named(text, OTHERS[plain], 1.0)
    if plain == "kn" and read == "m/s":
        plain = "knots"
    if parted := _PARTS.fullmatch(plain):
        return Named(text, "accelerations", STANDARD_GRAVITY / int(parted[1]))
    size, powers, place = 1.0, [0, 0, 0], 0
    for found in _FACTOR.finditer(plain):
        if found.start() != place or found[2] not in UNITS:
            return None
        place = found.end()
        factor, own = UNITS[found[2]]
        exponent = int(found[3] or 1) * (-1 if found[1] else 1)
        size *= factor**exponent
        powers = [power + exponent * each for power, each in zip(powers, own, strict=True)]
    l_t_m = (powers[0], powers[1], powers[2])
    if not plain or place != len(plain) or l_t_m not in QUANTITIES:
        return None
    quantity, one = QUANTITIES[l_t_m]
    return Named(text, quantity, one * size)


def units_in(header: str, read: str) -> tuple[list[Named], list[Named], list[str]]:
    """The units in the lines of a header: in brackets or behind a name and ``_``; of bare words; unknown ones.

    Unknown units are searched in the brackets of the last line and of lines with a known unit; directions and sentences
    are not units.
    """
    marked, bare, unknown = [], [], []
    lines = [line for line in header.splitlines() if line.strip()]
    for number, line in enumerate(lines, start=1):
        texts = [each[1] for each in _BRACKETS.finditer(line)]
        units = [unit_named(text, read) for text in texts]
        found = [*(unit for unit in units if unit), *_behind_names(_BRACKETS.sub(" ", line), read)]
        marked += found
        if found or number == len(lines):
            unknown += [text for text, unit in zip(texts, units, strict=True) if unit is None and _may_be_unit(text)]
        bare += _bare(_BRACKETS.sub(" ", line), read)
    return marked, bare, unknown


def _plain(text: str) -> str:
    """A spelling with ASCII signs, "/" for "per", blanks for products and no brackets."""
    plain = re.sub(r"\*\*", "^", text.strip().lower()).translate(_SIGNS)
    plain = re.sub(r"[()]", "", re.sub(r"\bper\b", "/", plain))
    return re.sub(r"\s+", " ", re.sub(r"\.(?=[a-z]|$)", " ", plain)).strip()


def _may_be_unit(text: str) -> bool:
    """Whether a text in brackets may be a unit: not a direction, number or sentence."""
    word = text.strip().lower()
    return bool(re.search(r"[a-zµμε%]", word)) and word not in NO_UNITS and (" " not in word or "/" in word)


def _behind_names(line: str, read: str) -> list[Named]:
    """Units behind names and "_", as in vel_cm_s; single letters other than s, m and g are indices."""
    found = []
    for each in _SUFFIX.finditer(line):
        parts = [part for part in each[1].split("_") if part.lower() != "per"]
        for first in range(len(parts)):
            text = "/".join(parts[first:])
            if (len(text) > 1 or text in "smg") and text != "in" and (unit := unit_named(text, read)):
                found.append(unit)
                break
    return found


def _bare(line: str, read: str) -> list[Named]:
    """Units among the words of a line: compound ones, such as cm/s, and words that cannot be anything else."""
    joined = _SPLIT_POWER.sub(r"\1.\2", re.sub(r"\s+per\s+|\s*/\s*", "/", line.translate(_SIGNS)))
    found = []
    for word in re.split(r"[\s,;:\"'=]+", joined):
        clear = word.lower() in CLEAR or (len(word) > 2 and re.search(r"/|-\d", word) is not None)
        if clear and (unit := unit_named(word, read) or unit_named(word.partition("/")[2], read)):
            whole = unit.spelled == word or "/" in unit.spelled or (unit.quantity == "times" and unit.size != 1.0)
            found += [unit] if whole else []
    return found

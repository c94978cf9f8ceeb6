"""Warnings about numbers that probably have another unit or sign, and about waves used for two quantities."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from dembound.casefile.magnitudes import sampling_warnings, waves_used
from dembound.casefile.messages import places
from dembound.casefile.model import Case
from dembound.meanings import GRAVITY, MEANINGS, Meaning
from dembound.table import Table
from dembound.waves.record_doubts import CUT
from dembound.words import percent, with_unit


def wave_use_warnings(case: Case) -> Iterator[str]:
    """Warnings about the use of waves, one line each."""
    yield from _two_quantities(case)
    yield from _jumps(case)
    yield from _doubts(case)


def users_of(case: Case, name: str) -> tuple[list[str], list[str]]:
    """The keys that take a wave as a velocity, and those that take it as the factor of a load."""
    velocities = [
        f"boundary.{side}.wave_{motion}"
        for side, waves in case.driving.items()
        for motion, each in waves.items()
        if each == name
    ]
    incident = getattr(case, "incident", None)
    velocities += ["incident.wave"] if incident is not None and incident.wave == name else []
    return velocities, [f"load.{load.name}" for load in case.load if load.wave == name]


def _two_quantities(case: Case) -> Iterator[str]:
    """Waves that are the velocity of a side and the factor of a load."""
    for name, wave in case.wave.items():
        velocities, factors = users_of(case, name)
        if velocities and factors:
            both = f"the velocity at {' and '.join(velocities)} and the factor of {' and '.join(factors)}"
            peak = f"{wave.peak():.4g}"
            yield f"wave.{name}: is {both}: its peak is {peak} m/s at the one and {peak} without unit at the other"


def _doubts(case: Case) -> Iterator[str]:
    """Warnings about measured histories whose units or samples are probably wrong, by use."""
    for name, wave in case.wave.items():
        velocities, _ = users_of(case, name)
        uses = [("m/s", 1.0)] if velocities else [_read_as(load) for load in case.load if load.wave == name]
        for doubt in wave.doubts(*uses[0]) if uses else ():
            yield f"wave.{name}: {doubt}"


def _read_as(load: Any) -> tuple[str, float]:
    """The unit in which a load takes its wave's values, and the factor by which it multiplies them."""
    if (pressure := getattr(load, "pressure", None)) is not None:
        return "Pa", pressure
    return ("N" if load.force is not None else "m/s²"), max(map(abs, load.vector))


def _jumps(case: Case) -> Iterator[str]:
    """Warnings about histories with a nonzero first or last value, at which they jump within the run."""
    for name, wave in case.wave.items():
        velocities, factors = users_of(case, name)
        if not velocities and not factors:
            continue
        unit = " m/s" if velocities else ""
        ends = [
            (end, time, value)
            for end, time, value in wave.ends()
            if 0.0 <= time < case.run.duration and abs(value) > CUT * wave.peak()
        ]
        if ends:
            listed = " and ".join(
                f"{end} at {value:.4g}{unit}, {percent(abs(value) / wave.peak())} of its peak, at {time:.4g} s"
                for end, time, value in ends
            )
            yield f"wave.{name}: {listed}, a jump from or to 0 beyond it; lead its file to 0 there, or shift its values"


LIGHTEST = 1.6
"""Least acceleration (m/s²) that is regarded as gravity: on the moon."""

DAMPED = "94 % are left after one wavelength at 0.1, 49 % at 0.3, 0.2 % at 0.7"
"""Peaks of three cycles of 50 m after 50 m along a row of disks of 1 m with local damping, over those without."""

GRAVITY_IN = ((1.0, "g"), (9810.0, "mm/s²"), (981.0, "cm/s²"), (0.00981, "km/s²"))
"""The acceleration of gravity in other units."""


def unlikely(case: Case) -> list[str]:
    """Warnings about unlikely numbers of a case, one line each."""
    lines = [line for path, table in _all_tables(case) for line in unlikely_in(path, table, case)]
    return [*lines, *sampling_warnings(case), *wave_use_warnings(case)]


def unlikely_in(path: str, table: Table, case: Case) -> Iterator[str]:
    """Warnings about one table, without the tables in it; path : its place in the file, or "" for only keys."""
    for name in type(table).model_fields:
        means, unit = meaning_of(table, name)
        numbers, key = _numbers(getattr(table, name)), ".".join(filter(None, (path, table.key_of(name))))
        if means is None or not numbers or (means in OF_STRENGTH and _has(case, "strength")):
            continue
        means_of, rule = MEANINGS[means], RULES.get(means)
        doubts = (doubt for value in numbers if (doubt := means_of.doubt(value, unit)))
        found = next(doubts, None) or _with_wave(numbers, means_of, unit, table, case)
        if found := found or (rule(numbers, table, case) if rule is not None else None):
            yield f"{key}: {found}"


def _with_wave(numbers: tuple[float, ...], means: Meaning, unit: str, table: Table, case: Case) -> str | None:
    """A warning about the numbers of a load times the peak of its wave."""
    is_load = any(table is load for load in case.load)  # other tables with a wave are not multiplied by it
    wave = case.wave.get(getattr(table, "wave", None) or "") if is_load else None
    if wave is None or means.is_free:
        return None
    doubts = (means.doubt(value * wave.peak(), unit, given=False) for value in numbers)
    return next((f"times the peak of wave.{table.wave} {doubt}" for doubt in doubts if doubt), None)  # type: ignore[attr-defined]


OF_STRENGTH = {"pressure of a load"}
"""Meanings that are compared with the strength, if the case has one."""


def meaning_of(table: Table | type[Table], name: str) -> tuple[str | None, str]:
    """The meaning of a field, None without one, and its unit."""
    known = table.described(name)
    means = known.get("means")
    return (str(means) if means else None), str(known.get("unit", "1"))


def _all_tables(case: Case) -> Iterator[tuple[str, Table]]:
    """All tables of a case, each with its place."""
    for key, value in case.tables.items():
        if isinstance(value, tuple):
            for number, each in enumerate(value, start=1):
                yield from _tables_in(f"{key}.{each.name or number}", each)
        elif isinstance(value, Mapping):
            for name, each in value.items():
                yield from _tables_in(f"{key}.{name}", each)
        elif isinstance(value, Table):
            yield from _tables_in(key, value)


def _tables_in(path: str, table: Table) -> Iterator[tuple[str, Table]]:
    """A table and those in it."""
    yield path, table
    for name in type(table).model_fields:
        value, place = getattr(table, name), f"{path}.{table.key_of(name)}"
        if isinstance(value, tuple) and value and isinstance(value[0], Table):
            for where, each in zip(places(place, [each.given() for each in value]), value, strict=True):
                yield from _tables_in(where, each)
        elif isinstance(value, Mapping):
            for inner, each in value.items():
                if isinstance(each, Table):
                    yield from _tables_in(f"{place}.{inner}", each)
        elif isinstance(value, Table):
            yield from _tables_in(place, value)


def _numbers(value: Any) -> tuple[float, ...]:
    """The numbers of a value, however deep in lists; none of a text or a truth value."""
    if isinstance(value, bool):
        return ()
    if isinstance(value, int | float):
        return (float(value),)
    return tuple(number for each in value for number in _numbers(each)) if isinstance(value, tuple) else ()


def _has(case: Case, means: str) -> bool:
    """Whether a case gives a number of this meaning."""
    return any(
        _numbers(getattr(table, name)) and meaning_of(table, name)[0] == means
        for _, table in _all_tables(case)
        for name in type(table).model_fields
    )


def _damps_waves(numbers: tuple[float, ...], table: Table, case: Case) -> str | None:
    """Local damping while waves run."""
    if numbers[0] == 0.0 or case.run.is_test or not waves_used(case):
        return None
    return (
        f"is {numbers[0]:g} while waves run: of a burst {DAMPED}; for waves write 0, [static] has a damping of its own"
    )


def _pulls(numbers: tuple[float, ...], table: Table, case: Case) -> str | None:
    """A given stress that is a tension along x or y."""
    pulling = [
        f"{with_unit(value, 'Pa')} along {axis}" for axis, value in zip("xy", numbers, strict=False) if value > 0.0
    ]
    turned = [-value if value > 0.0 else value for value in numbers[:2]]
    if not pulling:
        return None
    return (
        f"is a tension, {' and '.join(pulling)}; likely compression, which is negative: write "
        f"[{', '.join(f'{value:.6g}' for value in (*turned, *numbers[2:]))}]"
    )


def _not_downwards(numbers: tuple[float, ...], table: Table, case: Case) -> str | None:
    """A warning about a steady acceleration of the whole body unlike gravity: upwards, sideways or in another unit."""
    if not getattr(table, "is_everywhere", False):
        return None
    across, up = numbers
    if (wave := getattr(table, "wave", None)) is not None:
        is_weight = across == 0.0 and math.isclose(-up, GRAVITY, rel_tol=0.01)
        return f'is gravity times wave "{wave}"; a weight that stays has no wave' if is_weight else None
    if up > 0.0:
        return f"is {up:g} m/s² upwards; likely gravity: write [{across:g}, {-up:g}]"
    for size, unit in GRAVITY_IN:
        if across == 0.0 and math.isclose(-up, size, rel_tol=0.01):
            return f"is {up:g} m/s²; likely gravity in {unit}: write [0, {-GRAVITY:g}]"
    if up == 0.0 and math.isclose(abs(across), GRAVITY, rel_tol=0.01):
        return f"is {across:g} m/s² sideways; likely gravity: write [0, {-GRAVITY:g}]"
    light = across == 0.0 and -up < LIGHTEST  # sideways it may stand for an earthquake
    return f"is {-up:g} m/s², less than on the moon; gravity is [0, {-GRAVITY:g}]" if light else None


RULES: dict[str, Callable[[tuple[float, ...], Table, Case], str | None]] = {
    "local damping": _damps_waves,
    "stress to reach": _pulls,
    "acceleration": _not_downwards,
}
"""Meaning -> rule that compares a number with other numbers of the case and returns a warning or None."""

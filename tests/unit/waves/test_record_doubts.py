"""Measured records whose header or samples show that they are wrong."""

import numpy as np
import pytest

from dembound.waves.file_wave import header_of
from dembound.waves.record_doubts import doubts_of_header, doubts_of_samples

TIME = np.arange(0.0, 6.0, 0.01)


def motion(time: np.ndarray) -> np.ndarray:
    """An oscillation of 2 to 3 Hz that fades, m/s."""
    envelope = (time / 0.8) * np.exp(1.0 - time / 0.8)
    return 0.1 * envelope * np.sin(2.0 * np.pi * (2.0 + 0.15 * time) * time)


VELOCITY, LOAD = "m/s", "Pa"


@pytest.mark.parametrize(
    ("header", "read", "factor", "words"),
    [
        ("t (s), v (m/s)", VELOCITY, 1.0, []),
        ("", VELOCITY, 1.0, []),
        ("rates by g. m. at the west end, 2 m below it, according to him, every 5 ms", VELOCITY, 1.0, []),
        ("pressure on the bar, as a share of its peak (1)", LOAD, 1.0, []),
        ("time[ms] v[mm/s]", VELOCITY, 1.0, ["says ms", "scale = 0.001"]),
        ("time_s,vel_cm/s", VELOCITY, -1.0, ["scale = 0.01"]),
        ("time(s) acc(g)", VELOCITY, 1.0, ["likely accelerations"]),
        ("t(s) p(MPa)", LOAD, 1.0, ["scale = 1e+06"]),
        ("t(s) displacement (mm)", VELOCITY, 1.0, ["likely displacements"]),
        ("t(s) v(m/s), from cm/s", VELOCITY, 1.0, []),
        ("t(s) v[counts]", VELOCITY, 1.0, ["likely counts"]),
        ("time (s), velocity (furlong/s)", VELOCITY, 1.0, ['"furlong/s" in brackets, no unit']),
        ("t (s), a (g)", "m/s²", 1.0, ["scale = 9.80665"]),
        ("t (s), F (kN)", "N", 1.0, ["scale = 1000"]),
    ],
)
def test_units_of_a_header_are_compared_with_those_that_are_read(header, read, factor, words) -> None:
    found = list(doubts_of_header(header, read, factor))
    assert len(found) == len(words), found
    assert all(word in doubt for word, doubt in zip(words, found, strict=True)), found


PER_SECOND = ("/s", "/sec", "/second", " per second", " s^-1", " s-1", ".s-1", "·s⁻¹", " s**-1", " s^(-1)")
SPELLED = [
    *((VELOCITY, f"cm{per}", 0.01) for per in PER_SECOND),
    *((VELOCITY, unit, size) for unit, size in (("µm/s", 1e-6), ("centimetres per second", 0.01), ("CM/SEC", 0.01))),
    *((VELOCITY, unit, size) for unit, size in (("in/s", 0.0254), ("ft/s", 0.3048), ("knots", 0.514444))),
    *((VELOCITY, unit, size) for unit, size in (("kine", 0.01), ("km h^-1", 1.0 / 3.6), ("mph", 0.44704))),
    *((LOAD, unit, size) for unit, size in (("kN·m⁻²", 1e3), ("N/mm**2", 1e6), ("kgf/cm²", 98066.5))),
    *((LOAD, unit, size) for unit, size in (("kbar", 1e8), ("dyn/cm2", 0.1), ("psi", 6894.76), ("t/m2", 9806.65))),
]


@pytest.mark.parametrize("place", ["time (s), value ({})", "time value\n[s] [{}]"])
@pytest.mark.parametrize(("read", "unit", "size"), SPELLED)
def test_units_are_known_in_every_usual_spelling(read, unit, size, place) -> None:
    (doubt,) = doubts_of_header(place.format(unit), read, 1.0)
    assert f"scale = {size:g}" in doubt
    assert unit in doubt


@pytest.mark.parametrize("name", ["vel_cm_s", "v_cm_per_s", "vel_cms", "v cm s-1"])
def test_units_are_known_behind_names(name) -> None:
    (doubt,) = doubts_of_header(f"time_s, {name}", VELOCITY, 1.0)
    assert "scale = 0.01" in doubt


@pytest.mark.parametrize("unit", ["kN", "tonnes"])
def test_forces_are_no_pressures(unit) -> None:
    (doubt,) = doubts_of_header(f"time (s), load ({unit})", LOAD, 1.0)
    assert "likely forces; its values are read as pressures in Pa" in doubt


def test_the_words_above_the_numbers_are_the_header() -> None:
    assert header_of("# by hand\ntime [ms];v\n0;1\n1;2\n") == "by hand\ntime [ms];v"
    assert header_of("# of 200 samples\n# t, v (cm/s)\n0,1\n1,2\n") == "of 200 samples\nt, v (cm/s)"
    assert header_of("0 1\n# behind\n") == ""


def without(first: float, last: float) -> np.ndarray:
    return TIME[(first >= TIME) | (last <= TIME)]


SHORT = 1.0 - np.cos(2.0 * np.pi * np.clip((TIME - 1.0) / 2.0, 0.0, 1.0))  # one pulse from 1 to 3 s
TWO_SIDED = np.where(np.abs(TIME - 2.0) < 1.0, np.sin(np.pi * (TIME - 1.0)), 0.0)  # a period of a sine
SPIKE = np.where(np.arange(len(TIME)) == 222, 0.4, motion(TIME))
LOST = without(0.62, 0.75)


@pytest.mark.parametrize(
    ("time", "values", "words"),
    [
        (TIME, motion(TIME), None),
        (TIME, np.interp(TIME, [1.0, 1.1, 1.2], [0.0, 1.0, 0.0]), None),
        (TIME, np.sin(2.0 * np.pi * 0.7 * TIME), None),  # ends within a period
        (TIME, SHORT, None),
        (TIME, np.where(TIME < 2.0, 0.0, SHORT), None),  # fronts from rest, and back to it
        (TIME, np.where(np.abs(TIME - 2.0) < 1.0, 2.0 - TIME, 0.0), None),  # fronts of an N
        (TIME, np.where(TIME < 2.0, 0.5, np.exp(2.0 - TIME)), None),  # two levels of a load
        (TIME, np.where(TIME < 2.0, 1.0, -1.0) * SHORT, "times any other step, at 1.99 s: does its sign"),
        (TIME, np.where(TIME < 1.5, 1.0, -1.0) * TWO_SIDED, "does its sign change"),
        (TIME, np.where(TIME < 2.0, 1.0, 0.3) * SHORT, "times any other step, at 1.99 s: are samples lost?"),
        (LOST, motion(LOST), "no sample from 0.62 to 0.75 s, 13 times"),
        (TIME[: len(LOST)], motion(LOST), "jumps by"),
        (TIME, np.clip(motion(TIME), -0.05, 0.05), "clipped"),
        (TIME[::16], motion(TIME[::16]), "samples in a period of its mean frequency"),
        (TIME, SPIKE, "0.4 at 2.22 s: a spike"),
        (TIME, motion(TIME) + 0.003, "correct its baseline"),
    ],
)
def test_samples_show_what_is_wrong_with_them(time, values, words) -> None:
    found = list(doubts_of_samples(time, values))
    assert [words in doubt for doubt in found] == ([] if words is None else [True]), found

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


@pytest.mark.parametrize(
    ("header", "of_velocity", "factor", "words"),
    [
        ("t (s), v (m/s)", True, 1.0, []),
        ("", True, 1.0, []),
        ("rates by g. m. at the west end, 2 m below it, according to him, every 5 ms", True, 1.0, []),
        ("time[ms] v[mm/s]", True, 1.0, ["says ms", "scale = 0.001"]),
        ("time_s,vel_cm/s", True, -1.0, ["scale = 0.01"]),
        ("time_s,vel_cm/s", True, 0.01, []),
        ("time(s) acc(g)", True, 1.0, ["likely accelerations"]),
        ("t v(m/s2)", True, 1.0, ["likely accelerations"]),
        ("t(s) p(MPa)", False, 1.0, ["scale = 1e+06"]),
        ("t(s) p(MPa)", False, 1e6, []),
        ("t(s) displacement (mm)", True, 1.0, ["likely displacements"]),
    ],
)
def test_units_of_a_header_are_compared_with_those_that_are_read(header, of_velocity, factor, words) -> None:
    found = list(doubts_of_header(header, of_velocity=of_velocity, factor=factor))
    assert len(found) == len(words)
    assert all(word in doubt for word, doubt in zip(words, found, strict=True))


def test_the_words_above_the_numbers_are_the_header() -> None:
    assert header_of("# by hand\ntime [ms];v\n0;1\n1;2\n") == "by hand time [ms];v"
    assert header_of("0 1\n# behind\n") == ""


def without(first: float, last: float) -> np.ndarray:
    return TIME[(first >= TIME) | (last <= TIME)]


SPIKE = np.where(np.arange(len(TIME)) == 222, 0.4, motion(TIME))
LOST = without(0.62, 0.75)


@pytest.mark.parametrize(
    ("time", "values", "words"),
    [
        (TIME, motion(TIME), None),
        (TIME, np.where(TIME > 3.0, 1.0, 0.0), None),  # a step, a triangle and square waves are meant as they are
        (TIME, np.interp(TIME, [1.0, 1.1, 1.2], [0.0, 1.0, 0.0]), None),
        (TIME, np.sign(np.sin(2.0 * np.pi * 2.0 * TIME + 0.01)), None),
        (TIME, np.sin(2.0 * np.pi * 0.7 * TIME), None),  # ends within a period
        (TIME[:10], motion(TIME[:10]), None),
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

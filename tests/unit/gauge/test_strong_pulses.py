"""Strengths from a strong pulse with a fault of the record or a wrong option are warned of; right ones are not."""

import numpy as np
import pytest
from gauge_records import bits, drift, hum, noise, offset
from hopkinson_bar import SETUP, signals

from dembound.errors import CaseError
from dembound.gauge.gauge_io import BarMetadata, Gauge, read_gauge
from dembound.gauge.hopkinson.pulses import at_faces
from dembound.gauge.plausibility import differing_modulus
from dembound.gauge.spalling import evaluate

pytestmark = pytest.mark.slow

STEP, CREST, SPEED, DENSITY = 2e-7, 30e6, 3500.0, 2500.0
TIME = STEP * np.arange(2500)
BAR = (0.7, 1.2, DENSITY)
GIVEN = {"spall": 1.1, "speed": SPEED, "coefficient": 0.0}


def triangle(since, rise=30e-6, fall=110e-6):
    return np.clip(np.minimum(since / rise, 1.0 - (since - rise) / fall), 0.0, 1.0)


def bell(since):
    return np.sin(np.pi * np.clip(since / 120e-6, 0.0, 1.0)) ** 2


def rectangle(since):
    return np.clip(np.minimum(since, 120e-6 - since) / 1e-6, 0.0, 1.0)


def blast(since):
    return np.where(since >= 0.0, np.exp(-np.maximum(since, 0.0) / 30e-6), 0.0)


def stepped(since):
    return np.where((since >= 0.0) & (since < 120e-6), 0.5 ** np.floor(np.maximum(since, 0.0) / 40e-6), 0.0)


def returns(kept):
    """The reflection by the free end, of which a spall has kept a share, behind a front of a pulse that ends."""
    return lambda time, values: values + np.minimum(triangle(time - 20e-6 - 1.0 / SPEED), kept)


def lost(first, count):
    def change(time, values):
        return np.append(np.delete(values, slice(first, first + count)), np.zeros(count))

    return change


def coupled(constant):
    """First-order high pass."""

    def change(time, values):
        keep, out = np.exp(-STEP / constant), np.zeros(len(time))
        for k in range(1, len(time)):
            out[k] = keep * (out[k - 1] + values[k] - values[k - 1])
        return out

    return change


def burst(at, level, width=3e-6, period=3.2e-6):
    return lambda time, values: values + spike(at, level, width)(time, 0.0) * np.cos(6.3 * (time - at) / period)


def spike(at, level, width=2e-6):
    return lambda time, values: values + level * np.exp(-(((time - at) / width) ** 2))


def found(path, changes=(), pulse=triangle, bar=BAR, given=GIVEN, scale=CREST):
    """Findings from the pulse at the gauge, in compression, with changes and noise."""
    values = -pulse(TIME - 20e-6)
    for change in (*changes, noise(0.003)):
        values = change(TIME, values)
    np.savetxt(path, np.column_stack([TIME, scale * values]))
    return evaluate(read_gauge(path, None, *bar), **given)


NARROW = {**GIVEN, "spall": 1.15}
SHORT = {**GIVEN, "spall": 1.0}


@pytest.mark.parametrize(
    ("changes", "pulse", "given"),
    [
        pytest.param((), triangle, GIVEN, marks=pytest.mark.slow),
        pytest.param((), bell, GIVEN, marks=pytest.mark.slow),
        ((), rectangle, SHORT),  # breaks where the pulse has just its full length: 120 µs · c/2 = 0.21 m
        ((), blast, NARROW),
        ((), stepped, NARROW),
        ((returns(1.0),), triangle, GIVEN),
        pytest.param((returns(0.5),), triangle, GIVEN, marks=pytest.mark.slow),
        ((offset(0.1),), triangle, GIVEN),
        ((drift(0.05),), bell, GIVEN),
        ((hum(0.05),), triangle, GIVEN),
        pytest.param((noise(0.01),), triangle, GIVEN, marks=pytest.mark.slow),
        ((noise(0.005), bits(8)), bell, GIVEN),
    ],
)
def test_what_is_right_is_not_warned_of(changes, pulse, given, tmp_path):
    assert found(tmp_path / "strong.txt", changes, pulse, given=given).warnings == ()


@pytest.mark.parametrize(
    ("changes", "pulse", "words"),
    [
        ((lost(350, 150),), triangle, "jumps by 27 % of its crest in one sample, at 7e-05 s"),
        ((lost(150, 60),), triangle, "jumps by 4"),
        ((lost(350, 200),), bell, "in one sample, at 7e-05 s: are samples lost"),
        ((lost(200, 100),), blast, "in one sample, at 4e-05 s: are samples lost"),
        ((coupled(2e-4),), triangle, "as by AC coupling"),
        ((coupled(1e-3), offset(0.2)), bell, "decays in 0.001 s, as by AC coupling"),
        ((coupled(5e-4), returns(1.0)), triangle, "as by AC coupling"),
        ((burst(70e-6, 0.2),), triangle, "a spike or a burst of noise"),
        ((spike(60e-6, 0.25),), triangle, "a spike or a burst of noise"),
        ((spike(60e-6, 0.25, 1e-6),), bell, "a spike or a burst of noise"),
    ],
)
def test_a_fault_of_the_record_is_reported(changes, pulse, words, tmp_path):
    assert any(words in said for said in found(tmp_path / "strong.txt", changes, pulse).warnings)


@pytest.mark.parametrize(
    ("changes", "bar", "given", "scale", "words"),
    [
        ((), BAR, {"spall": 0.1}, CREST, ["all of the tension at 0.1 m, 29."]),
        ((), BAR, {"speed": 350.0}, CREST, ["all of the tension at 1.1 m"]),
        ((), (0.7, 2.4, DENSITY), {}, CREST, ["all of the tension at 1.1 m"]),
        ((), BAR, {"pulse_end": 75e-6}, CREST, ["cuts the pulse at 7.5e-05 s, where it has 7"]),
        ((returns(1.0),), BAR, {"speed": 6000.0}, CREST, ["the front of the pulse is back at the gauge as with 3"]),
        ((returns(0.5),), BAR, {"speed": 3800.0}, CREST, ["the front of the pulse is back at the gauge as with 3"]),
        ((), BAR, {"coefficient": 4.5}, CREST, ["leaves 0.45 % of a wave along the bar of 1.2 m; is it in 1/m?"]),
        ((), BAR, {}, 30.0, ["the nominal strength is 15.6", "the attenuated strength is 15.6"]),
    ],
)
def test_an_option_that_cannot_be_is_reported(changes, bar, given, scale, words, tmp_path):
    warnings = found(tmp_path / "strong.txt", changes, bar=bar, given=GIVEN | given, scale=scale).warnings
    assert len(warnings) == len(words), warnings
    assert all(word in said for word, said in zip(words, warnings, strict=True))


@pytest.mark.parametrize(
    ("velocity", "words"),
    [
        (lambda since: triangle(since), []),
        (lambda since: triangle(since) - spike(60e-6, 0.2)(since, 0.0), ["--free-end: the velocity has a spike"]),
        (lambda since: lost(300, 100)(since, triangle(since)), ["--free-end: the velocity jumps by"]),
        (lambda since: 100.0 * triangle(since), ["--free-end: its largest velocity, 700 m/s, is of a wave of 10 % st"]),
    ],
)
def test_the_velocity_of_a_free_end_is_checked(velocity, words):
    since = TIME - 20e-6
    again = 4.0 * triangle(since - 200e-6, 60e-6, 60e-6)
    free_end = TIME, 7.0 * velocity(since) + again * velocity(np.array([30e-6]))[0]
    gauge = Gauge(TIME, -CREST * triangle(since), *BAR)
    warnings = evaluate(gauge, free_end=free_end, speed=SPEED, coefficient=0.0).warnings
    assert [word in said for word, said in zip(words, warnings, strict=True)] == [True] * len(words)


@pytest.mark.parametrize(("spall", "count"), [(1.1, 0), (1.092, 0), (1.109, 0), (1.085, 1), (1.115, 1)])
def test_a_spall_is_compared_with_the_first_crack_of_results(spall, count):
    metadata = BarMetadata(SPEED, 0.0, ("free", "free"), 4e-4, first_crack=1.1)
    found = evaluate(Gauge(TIME, -CREST * triangle(TIME - 20e-6), *BAR, metadata), spall=spall)
    assert sum("the results have their first crack at 1.1 m" in said for said in found.warnings) == count


@pytest.mark.parametrize(("apart", "count"), [(0.96, 0), (1.04, 0), (0.94, 1), (1.06, 1)])
def test_a_modulus_some_way_from_density_and_speed_is_reported(apart, count):
    modulus = apart * DENSITY * SPEED**2
    assert len(list(differing_modulus(modulus, DENSITY, SPEED))) == count
    assert not list(differing_modulus(modulus, None, SPEED))


def test_an_undershoot_before_the_reflection_is_no_long_pulse():
    given = signals()
    coupled_too = given._replace(incident=given.incident - 0.1 * given.incident.max() * (given.time > 460e-6))
    with pytest.raises(CaseError, match=r"INCIDENT: .* -1[0-9.]* % of its crest at .*, the other sign: look for AC c"):
        at_faces(coupled_too, SETUP)

"""Gauges of a split Hopkinson test give the modulus of a linear specimen, where it is in equilibrium, and say where."""

from dataclasses import replace

import numpy as np
import pytest
from hopkinson_bar import (
    AREA,
    LENGTH,
    MODULUS,
    SETUP,
    SPECIMEN_AREA,
    SPECIMEN_MODULUS,
    SPECIMEN_SPEED,
    SPEED,
    STEP,
    ramp,
    signals,
)

from dembound.errors import CaseError
from dembound.gauge.hopkinson import Windows, at_faces, specimen


def found_of(given, setup=SETUP, windows=None):
    """The specimen, from signals."""
    return specimen(at_faces(given, setup, windows), setup)


@pytest.mark.parametrize("rise", [150e-6, 20e-6])
def test_the_slope_in_equilibrium_is_the_modulus(rise):
    found = found_of(signals(lambda time: ramp(time, rise)))
    assert found.slope == pytest.approx(SPECIMEN_MODULUS, rel=0.01)
    # after six transits of 4 µs forces on an elastic specimen of this impedance, a seventh of the bars', agree to some
    # per cent under a step (Ravichandran & Subhash 1994); under a ramp the difference is one transit's share of it
    first, end = found.equilibrium
    assert found.time[first] > LENGTH / SPECIMEN_SPEED
    assert np.all(np.abs(found.ratio[first:end] - 1.0) <= 0.025 * (found.ratio[first:end] + 1.0))


def test_stress_and_rate_are_those_of_the_plateau():
    found = found_of(signals(lambda time: ramp(time, 50e-6)))
    on = (found.time > 200e-6) & (found.time < 280e-6)
    # a specimen at rest between the bars lets all through: E A e / A_s, and no rate
    expected = MODULUS * AREA / SPECIMEN_AREA * 1e-3
    for stress in (found.front, found.back, found.stress):
        np.testing.assert_allclose(stress[on], expected, rtol=0.01)
    np.testing.assert_allclose(found.strain[on], expected / SPECIMEN_MODULUS, rtol=0.01)
    # rates by one and three waves differ by c/L_s times the difference of the forces, over EA
    difference = (found.front - found.back) * SPECIMEN_AREA / (MODULUS * AREA)
    np.testing.assert_allclose(
        found.rate - found.one_wave_rate, SPEED / LENGTH * difference, atol=1e-6 * found.rate.max()
    )


def test_a_specimen_that_is_never_in_equilibrium_is_reported():
    # the transmitted wave of a pulse of one transit comes after all of the incident one: F_1 and F_2 take turns
    found = found_of(signals(lambda time: ramp(time, 2e-6, 4e-6)))
    assert found.equilibrium is None
    assert np.isnan(found.slope)
    assert not found.in_equilibrium.any()


@pytest.mark.parametrize(("modulus", "density"), [(5e9, 1500.0), (80e9, 2700.0)])
def test_weak_and_hard_specimens_have_their_modulus(modulus, density):
    """Under a slow rise with noise of 1 %; inertia of the specimen adds less than 0.1 % at a rise of 150 µs."""
    given = signals(specimen=(float(np.sqrt(modulus / density)), density))
    incident, transmitted = 1e-5 * np.random.default_rng(1).standard_normal((2, len(given.time)))
    noisy = given._replace(incident=given.incident + incident, transmitted=given.transmitted + transmitted)
    assert found_of(noisy).slope == pytest.approx(modulus, rel=0.02)


def test_an_attenuation_of_the_bars_is_taken_back():
    """The incident pulse loses e^(−αd) on its way to the specimen, the others on theirs from it."""
    plain, alpha = signals(), 0.1
    before, after = np.exp(alpha * SETUP.incident_gauge), np.exp(-alpha * SETUP.incident_gauge)
    incident = np.where(plain.time < 470e-6, before, after) * plain.incident
    transmitted = np.exp(-alpha * SETUP.transmitted_gauge) * plain.transmitted
    lossy = plain._replace(incident=incident, transmitted=transmitted)
    found = found_of(lossy, replace(SETUP, attenuation=alpha))
    np.testing.assert_allclose(found.front, found_of(plain).front, rtol=1e-9, atol=1.0)
    np.testing.assert_allclose(found.back, found_of(plain).back, rtol=1e-9, atol=1.0)


def test_windows_may_be_given_and_move_their_pulse():
    given, begin, late = signals(), 480e-6, 50 * STEP
    faces, shifted = (
        at_faces(given, SETUP, Windows(reflected=(begin + shift, begin + 350e-6))) for shift in (0.0, late)
    )
    count = len(shifted.time)
    np.testing.assert_allclose(shifted.reflected, faces.reflected[50 : 50 + count], atol=1e-12)
    np.testing.assert_allclose(shifted.incident, faces.incident[:count], atol=1e-12)


def test_pulses_that_are_not_within_the_record_or_overlap_are_refused():
    """At the gauges the incident pulse begins at 100 µs, the reflected at 500, the transmitted at 460."""
    given, long = signals(), signals(lambda time: ramp(time, 200e-6, 600e-6))
    short = given._replace(**{name: getattr(given, name)[: round(350e-6 / STEP)] for name in given._fields})
    for of, setup, windows, said in (
        (short, SETUP, Windows(), "begin at .* s at their gauges, the record is from 0 to"),
        (given, SETUP, Windows(incident=(1.3e-3, 1.5e-3)), "begin at 0.0013, 0.0017, .* the record is from 0 to"),
        (given, replace(SETUP, bar_length=1.3), Windows(), "the incident pulse has not ended at .* of its crest"),
        (long, SETUP, Windows(), "the incident pulse has not ended at .* when its reflection is back"),
        (given._replace(incident=0.0 * given.time), SETUP, Windows(), "the incident gauge shows no load"),
    ):
        with pytest.raises(CaseError, match=f"--incident-window: .*{said}"):
            at_faces(of, setup, windows)

"""The settings that waves need."""

import math

import numpy as np
import pytest

from dembound.continuum import sizing
from dembound.continuum.medium import Medium
from dembound.continuum.sizing import Signal
from dembound.waves import Constant, Cosine, Wave

ROCK = Medium.isotropic(2500.0, 1000.0, 500.0)


def pulse(period: float = 0.5, amplitude: float = 1.0) -> Cosine:
    return Cosine(type="cosine", period=period, amplitude=amplitude)


def moved(wave: Wave) -> Signal:
    return Signal(wave, is_force=False)


def pushed(wave: Wave) -> Signal:
    return Signal(wave, is_force=True)


def exact_share(x: float, power: int) -> float:
    """Share of the energy of ½(1 − cos 2πt/T) times ω^power above x/T; the spectrum is sin(πy)/(πy(1 − y²)), y = fT."""
    y = np.linspace(1e-6, 400.0, 4_000_001)
    energy = y**power * (np.sinc(y) / (1.0 - y**2)) ** 2
    energy[np.abs(y - 1.0) < 1e-9] = 0.25
    return float(energy[y > x].sum() / energy.sum())


@pytest.mark.parametrize(
    ("signal", "power", "share"),
    [pytest.param(moved, 0, 1e-2, marks=pytest.mark.slow), (moved, 0, 1e-6), (pushed, 1, 1e-3)],
)
def test_the_cut_off_of_the_cosine_pulse_is_that_of_its_spectrum(signal, power: int, share: float) -> None:
    found = sizing.cutoff(signal(pulse(0.5)), share)

    # in multiples of 1/8T, of which one more or less is passed; 99.9 % of a velocity's energy lie below 1.734/T
    assert exact_share(0.5 * found + 0.125, power) < share < exact_share(0.5 * found - 0.25, power)
    assert sizing.cutoff(signal(pulse(0.5, amplitude=-7.0)), share) == found
    assert sizing.cutoff(signal(pulse(0.05)), share) == pytest.approx(10.0 * found)


def test_of_a_force_that_stays_the_rise_counts() -> None:
    """Its rate is a Hann lobe, so body waves have a thousandth of their energy above 1.5/rise; a step has no limit."""
    y = np.linspace(0.125, 100.0, 800_000)
    energy = (np.sinc(y) / (1.0 - y**2)) ** 2 / y
    rise = Constant(type="constant", amplitude=2.0, rise=0.2)
    found = 0.2 * sizing.cutoff(pushed(rise))

    assert energy[y > found + 0.125].sum() / energy.sum() < 1e-3 < energy[y > found - 0.25].sum() / energy.sum()
    assert sizing.cutoff(pushed(Constant(type="constant", amplitude=2.0))) == math.inf


def test_mean_frequencies_are_those_of_the_motion() -> None:
    """½(1 − cos 2πt/T), whose rate is sin(2πt/T) π/T; its displacement is ½(t − sin(2πt/T) T/2π), then ½T."""
    square = 0.25 * (1.0 / 3.0 + 2.5 / (2.0 * math.pi) ** 2)
    for times, stays in ((1.0, 0.0), (3.0, 0.5)):
        found = sizing.mean_frequency(moved(pulse(0.5)), 1.0 / (times * 0.5))
        assert found == pytest.approx(math.sqrt(0.375 / (square + stays)) / (2.0 * math.pi * 0.5), rel=2e-3)
    assert sizing.mean_frequency(moved(pulse(0.5))) == pytest.approx(1.0 / (0.5 * math.sqrt(3.0)), rel=1e-2)
    assert sizing.wave_number([moved(pulse(0.5)), moved(pulse(0.1))], ROCK) == pytest.approx(
        2.0 * math.pi / (0.1 * math.sqrt(3.0)) / 500.0, rel=1e-2
    )
    assert sizing.mean_frequency(moved(Constant(type="constant", amplitude=2.0)), 1.0) == math.inf
    assert sizing.wave_number([], ROCK) == 0.0


@pytest.mark.parametrize("order", [3, 6])
def test_elements_return_a_share_of_the_energy_that_is_the_accuracys_square(order: int) -> None:
    signals = [pushed(pulse(0.2))]
    size = sizing.element_size(signals, ROCK, order, 1e-3)

    assert sizing.element_size([pushed(pulse(0.1))], ROCK, order, 1e-3) == pytest.approx(0.5 * size)
    assert sizing.element_error(signals, ROCK, order, size) == pytest.approx(1e-3, rel=0.05)  # of steps of 1/8T
    # the spectrum of velocities falls with the fifth power, energies beyond a frequency with the fourth
    assert sizing.element_error(signals, ROCK, order, 2.0 * size) == pytest.approx(4e-3, rel=0.1)
    assert sizing.element_size(signals, ROCK, order, 1e-2) == pytest.approx(3.1 * size, rel=0.1)
    assert sizing.element_error([pushed(Constant(type="constant", amplitude=1.0))], ROCK, order, size) == 1.0


def test_a_lasting_force_needs_room_in_proportion_to_its_time() -> None:
    inner = sizing.inner_length(10.0, 1000.0, 0.3, 1e-3)

    # α0 t = 5, at which half of a thousandth is missing: 0.3·1000·10/2L
    assert inner == pytest.approx(300.0)
    assert sizing.inner_length(20.0, 2000.0, 0.3, 1e-3) == pytest.approx(4.0 * inner)
    assert sizing.inner_length(10.0, 1000.0, 0.1, 1e-3) == pytest.approx(inner / 3.0)
    assert sizing.missing(10.0, 1000.0, 0.3, inner) == pytest.approx(5e-4)
    assert sizing.missing(10.0, 1000.0, 0.3, 0.5 * inner) == pytest.approx(2e-3)


def test_what_the_surface_sends_back_along_layers() -> None:
    """S waves keep R0^(cos θ c_p/c_s): with a depth of 3 and an offset of 4, cos θ = 0.8."""
    assert sizing.grazing_error(3.0, 0.5, 1e-4, 4.0) == pytest.approx(1e-4**1.6)
    assert sizing.grazing_error(3.0, 1.0, 1e-4, 0.0) == 1.0
    for depth, ratio, accuracy in ((100.0, 0.7, 1e-3), (20.0, 0.5, 1e-2)):
        offset = sizing.offset(depth, ratio, 1e-4, accuracy)
        assert sizing.grazing_error(depth, ratio, 1e-4, offset) == pytest.approx(accuracy)
    assert sizing.offset(10.0, 1.0, 1e-3, 1e-3) == pytest.approx(10.0 * 0.9 / 0.19**0.5)  # not infinite
    assert sizing.offset(0.0, 0.7, 1e-4, 1e-3) == 0.0

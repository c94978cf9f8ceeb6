"""The elements that waves need."""

import math

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.casefile.run import Run
from dembound.errors import CaseError
from dembound.outside.choice import cutoff, element_size, shortest_wave
from dembound.outside.medium import Medium
from dembound.waves import Cosine

ROCK = Medium.isotropic(2500.0, 1000.0, 500.0)


def pulse(period: float = 0.5, amplitude: float = 1.0) -> Cosine:
    return Cosine(type="cosine", period=period, amplitude=amplitude)


def case(**waves: Cosine) -> Case:
    return Case(run=Run(duration=1.0), name="waves", wave=waves)


def test_the_cut_off_of_the_cosine_pulse_is_nearly_twice_its_frequency() -> None:
    # 99.9 % of the energy of (1 − cos 2πt/T)/2 lies below 1.734/T (64 times finer); here in multiples of 1/(4T)
    whole = cutoff(pulse())
    assert whole == pytest.approx(1.75 / 0.5)
    assert cutoff(pulse(amplitude=-7.0)) == whole
    assert cutoff(pulse(period=0.05)) == pytest.approx(10.0 * whole)


def test_the_slowest_wave_at_the_highest_cut_off_counts() -> None:
    both = case(slow=pulse(1.0), fast=pulse(0.1))
    assert shortest_wave(both, ROCK) == pytest.approx(500.0 / cutoff(pulse(0.1)), rel=1e-9)


def test_elements_are_smaller_for_shorter_waves_and_smaller_errors() -> None:
    size = element_size(case(w=pulse(0.5)), ROCK, 0.01)
    assert element_size(case(w=pulse(0.25)), ROCK, 0.01) == pytest.approx(0.5 * size)
    assert element_size(case(w=pulse(0.5)), ROCK, 0.01, accuracy=2.5e-4) == pytest.approx(0.5 * size)
    # 24 nodes a wavelength for 0.05 %, so 24/√2 for 0.1 %
    nodes = 4.0 * shortest_wave(case(w=pulse(0.5)), ROCK) / size
    assert nodes == pytest.approx(24.0 / math.sqrt(2.0))


def test_nodes_are_never_closer_than_disks() -> None:
    assert element_size(case(w=pulse(1e-4)), ROCK, 0.5, order=6) == pytest.approx(6 * 1.25 * 0.5)


def test_without_a_wave_the_size_has_to_be_given() -> None:
    with pytest.raises(CaseError, match=r"outside\.element: is 0"):
        element_size(case(), ROCK, 0.5)


def test_the_slowest_direction_of_a_medium_without_symmetry_is_found() -> None:
    medium = Medium(2500.0, 9e9, 7e9, 2e9, 3e9, 0.4e9, -0.3e9)
    slowest = min(medium.plane_waves((math.cos(a), math.sin(a)))[0][0] for a in np.linspace(0.0, math.pi, 721))
    assert shortest_wave(case(w=pulse(0.5)), medium) * cutoff(pulse(0.5)) == pytest.approx(slowest, rel=2e-3)

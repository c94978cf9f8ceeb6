"""The frequencies of the waves of a case."""

import math

import pytest
from small_cases import GRAINS, small

from dembound.disks.scene import ground_of
from dembound.disks.surroundings.frequencies import frequencies_of, mean_frequency, share_above


def test_the_mean_frequency_is_that_of_the_energy() -> None:
    case = small(GRAINS | {"wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 20.0}}})
    # energies f⁴ exp(−2f²/f0²): f0 Γ(3)/(√2 Γ(5/2)); samples of a Ricker wavelet cut off where it is 1e-4
    assert mean_frequency(case) == pytest.approx(20.0 * math.gamma(3.0) / (math.sqrt(2.0) * math.gamma(2.5)), rel=1e-3)
    silent = {key: value for key, value in GRAINS.items() if key not in ("wave", "boundary")}
    assert math.isnan(mean_frequency(small(silent)))


def test_a_single_frequency_halves_the_energy() -> None:
    case = small(GRAINS)
    (wave,), (middle,) = case.wave.values(), frequencies_of(case, ground_of(case), 1)
    assert share_above(wave, middle) == pytest.approx(0.5, abs=0.15)  # one sample of so short a pulse's spectrum

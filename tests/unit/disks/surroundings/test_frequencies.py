"""The frequencies of the waves of a case."""

import math

import numpy as np
import pytest
from small_cases import GRAINS, small

from dembound.disks.scene import ground_of
from dembound.disks.surroundings.frequencies import frequencies_of, mean_frequency


def test_frequencies_share_the_energy_of_the_waves_evenly() -> None:
    case = small(GRAINS)
    found = frequencies_of(case, ground_of(case), 200)
    wave = case.wave["pulse"]
    t = np.linspace(0.0, 0.64, 2**17, endpoint=False)
    energy = np.abs(np.fft.rfft(wave.velocity(t))) ** 2
    share = np.cumsum(energy) / energy.sum()
    frequencies = np.fft.rfftfreq(len(t), t[1])
    for number in (20, 100, 180):
        expected = np.interp((number + 0.5) / 200, share, frequencies)
        # one line of either spectrum at most
        assert found[number] == pytest.approx(expected, abs=2.0 / 0.64)
    assert (np.diff(found) > 0.0).all()


def test_the_mean_frequency_is_that_of_the_energy() -> None:
    case = small(GRAINS | {"wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 20.0}}})
    # energies f⁴ exp(−2f²/f0²): f0 Γ(3)/(√2 Γ(5/2)); samples of a Ricker wavelet cut off where it is 1e-4
    assert mean_frequency(case) == pytest.approx(20.0 * math.gamma(3.0) / (math.sqrt(2.0) * math.gamma(2.5)), rel=1e-3)
    silent = {key: value for key, value in GRAINS.items() if key not in ("wave", "boundary")}
    assert math.isnan(mean_frequency(small(silent)))

"""The setup of a split Hopkinson test: moduli, areas and dispersion of its round bars."""

import pytest

from dembound.errors import CaseError
from dembound.gauge.hopkinson.pulses import Setup
from dembound.gauge.hopkinson.separation import LongBar

BARS = (5000.0, 8000.0, 0.02)
LENGTHS = (1.0, 0.8, 0.01, 2e-4)


def test_round_bars_have_the_modulus_of_their_waves_and_disperse_with_their_radius() -> None:
    setup = Setup.of_round_bars(*BARS, *LENGTHS, attenuation=0.1, poisson=0.3, second_gauge=0.5, bar_length=2.0)
    assert setup.bar == LongBar(5000.0, 0.1)
    assert setup.modulus == pytest.approx(200e9, rel=1e-12)
    assert setup.area == pytest.approx(3.14159265e-4, rel=1e-8)
    assert (setup.incident_gauge, setup.transmitted_gauge, setup.specimen_length, setup.specimen_area) == LENGTHS
    assert (setup.second_gauge, setup.bar_length) == (0.5, 2.0)
    assert Setup.of_round_bars(*BARS, *LENGTHS, modulus=190e9).modulus == 190e9
    setup = Setup.of_round_bars(*BARS, *LENGTHS, poisson=0.3, disperse=True)
    assert setup.bar == LongBar(5000.0, 0.0, 0.01, 0.3)
    for poisson in (None, 0.0, 0.5):
        with pytest.raises(CaseError, match="--poisson: is needed by --dispersion-correction"):
            Setup.of_round_bars(*BARS, *LENGTHS, poisson=poisson, disperse=True)

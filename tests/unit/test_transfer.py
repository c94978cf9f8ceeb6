"""Transfer functions between two histories."""

import numpy as np

from dembound.spectra import FADED, transfer_function

STEP, COUNT = 0.01, 1000


def pulse(at: float) -> np.ndarray:
    """A Ricker wavelet of 5 Hz whose crest is at a time (s)."""
    x = (np.pi * 5.0 * (STEP * np.arange(COUNT) - at)) ** 2
    return (1.0 - 2.0 * x) * np.exp(-x)


def test_a_delay_and_a_gain_are_found():
    found = transfer_function(-2.5 * pulse(1.37), pulse(1.0), STEP)
    clear = ~np.isnan(found.ratio)
    expected = -2.5 * np.exp(-2j * np.pi * found.frequency * 0.37)
    # both spectra have rounding errors of 1e-16·COUNT of their peak, and at least FADED of it
    np.testing.assert_allclose(found.ratio[clear], expected[clear], rtol=0.0, atol=2.5 * 1e-13 / FADED)
    np.testing.assert_allclose(found.amplitude[~np.isnan(found.amplitude)], 2.5, rtol=1e-10)


def test_no_ratio_where_the_input_has_no_energy():
    noise = 1e-6 * np.random.default_rng(2).standard_normal(COUNT)
    found = transfer_function(pulse(1.0) + noise, pulse(1.0), STEP)
    # the spectrum x² e^(1 − x²), x = f/5 Hz, is 1 % of its largest at x = 0.0609 and 2.754
    clear = found.centre[~np.isnan(found.amplitude)]
    assert 0.0609 * 5.0 / 1.2 < clear[0] < 0.0609 * 5.0 * 1.2
    assert 2.754 * 5.0 / 1.2 < clear[-1] < 2.754 * 5.0 * 1.2
    raw = found.frequency[~np.isnan(found.ratio)]
    assert clear[0] <= raw[0]
    assert raw[-1] <= clear[-1]

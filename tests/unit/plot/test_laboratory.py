"""A gauge's history and the stress beside the free end are drawn in MPa."""

import numpy as np
import pytest

from dembound.gauge.gauge_io import Gauge
from dembound.gauge.spalling import evaluate
from dembound.plot.laboratory import plot_gauge


@pytest.fixture
def gauge(felt):
    """A gauge that has measured a pulse of 1 MPa."""
    time, stress = felt()
    return Gauge(time, 1e6 * stress, 0.6, 0.99, None)


def test_the_history_is_drawn_with_its_peaks_and_their_fit(gauge):
    found = evaluate(gauge)
    (panel,) = plot_gauge(gauge, found).axes
    history, peaks, fit = panel.lines
    np.testing.assert_allclose(history.get_xdata(), 1e3 * gauge.time)
    np.testing.assert_allclose(history.get_ydata(), gauge.stress / 1e6)
    np.testing.assert_allclose(peaks.get_ydata(), found.peaks.height / 1e6)
    # the fit meets the peaks it is made of as well as half a sample lets them be known, 1 %
    np.testing.assert_allclose(np.interp(peaks.get_xdata(), *fit.get_data()), peaks.get_ydata(), rtol=0.01)


def test_a_spalled_bar_shows_the_stress_near_its_end(gauge):
    found = evaluate(gauge, spall=0.9)
    _, panel = plot_gauge(gauge, found).axes
    *lines, mark, _ = panel.lines
    assert len(lines) == 5
    for line in lines:
        assert line.get_ydata()[-1] == pytest.approx(0.0, abs=1e-12)  # the end is free
    assert mark.get_data() == (pytest.approx([0.9]), pytest.approx([found.strength.nominal / 1e6]))
    # the fourth line is that of the time of the largest tension, which stands in it, between two of its points
    through = np.interp(0.9, *lines[3].get_data())
    between = (0.99 - 0.6) / 499 / 2740.0 / 40e-6  # the steeper side of the pulse over the way from point to point
    assert through == pytest.approx(found.strength.nominal / 1e6, abs=between)

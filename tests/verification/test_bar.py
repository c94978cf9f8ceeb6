"""Z's bar of pattern A, one row of it: the pulse runs 1000 m at 1000 m/s and leaves through the dashpots."""

import numpy as np
import pytest

LENGTH, PERIOD = 1000.0, 0.5
PLACES = (0.0, 250.0, 500.0, 750.0, 1000.0)
PULSE_LENGTH = 500.0
PER_DISK = 2.0 * np.pi * 0.5 / PULSE_LENGTH
"""qa of the pulse's main wave, whose length is cT."""


@pytest.fixture(scope="module")
def history(lab):
    scene = lab.scene(
        "A",
        (LENGTH, lab.diameter),
        boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"},
        wave=lab.pulse(PERIOD),
    )
    return lab.run(scene, lab.nearest(scene, [(x, 0.0) for x in PLACES]), 2.0)


def test_peak_is_the_same_everywhere(history):
    """Without damping or scattering nothing is lost; the end adds its reflection's error of second order."""
    # dispersion moves the parts of the pulse by (qa)²/24 of the way, 0.007 % of its length over 1 km: no 0.1 %
    peaks = history.velocity[:, :, 0].max(axis=0)
    print(peaks/.5-1)
    np.testing.assert_allclose(peaks, 0.5, rtol=1e-3)


def test_arrives_at_the_wave_speed(lab, history):
    """Group speed c(1 − (qa)²/8): 5 µs late after 1 km, a hundredth of a step."""
    places = np.array([lab.diameter * (0.5 + np.floor(x / lab.diameter - 1e-9)) for x in PLACES[1:]])
    first = 0.5 * lab.diameter  # the driven disk
    expected = (places - first) / lab.speed + 0.25 * PERIOD
    print((history.crossing(0.25)[1:]-expected)/history.times[1])
    np.testing.assert_allclose(history.crossing(0.25)[1:], expected, rtol=0, atol=0.0)

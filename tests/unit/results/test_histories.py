"""Histories in the units they are shown in, and moduli read off the curve of a laboratory test."""

import h5py
import numpy as np
import pytest

from dembound.results.histories import read_histories
from dembound.results.recording import LoadingCurve


def test_accelerations_are_central_differences_of_the_velocity(small_run):
    history = read_histories(small_run, "acceleration")["front"]
    with h5py.File(small_run) as file:
        time, velocity = (file["histories/front"][name][:] for name in ("time", "velocity"))
    inner = (velocity[2:] - velocity[:-2]) / (time[2:] - time[:-2])[:, None]
    # times are whole multiples of a step, rounded: differences of theirs differ by 1e-13 of a step or less
    np.testing.assert_allclose(history.values[1:-1], inner, rtol=1e-9, atol=1e-9 * np.abs(inner).max())
    np.testing.assert_allclose(history.values[0], (velocity[1] - velocity[0]) / (time[1] - time[0]))


TIME = np.linspace(0.0, 3.0, 301)
RATE = 0.002


def curve(pressure: float = 0.0, crack_time: tuple[float, ...] = (0.8, 1.5, 2.5)) -> LoadingCurve:
    """Straight to the peak at 2 s, after which the stress falls; a stiffer foot up to a tenth of the peak."""
    strain = RATE * TIME
    stress = np.interp(TIME, [0.0, 0.1, 2.0, 3.0], [0.0, 4e6, 40e6, 10e6])
    times = TIME[::10]
    return LoadingCurve(
        kind="biaxial" if pressure else "ucs",
        time=TIME,
        stress=stress + pressure,
        pressure=pressure,
        strain=1.1 * strain,  # platens stiffen or soften the ends
        gauge_time=times,
        axial=RATE * times,
        lateral=0.3 * RATE * times,
        crack_time=np.array(crack_time),
        crack_shear=np.array([False, True, False])[: len(crack_time)],
    )


@pytest.mark.parametrize("pressure", [0.0, 5e6])
def test_moduli_are_slopes_of_the_middle_between_shares_of_the_peak(pressure: float) -> None:
    found = curve(pressure)
    young, poisson = found.elastic(0.15, 0.9)

    assert young == pytest.approx(36e6 / (1.9 * RATE), rel=1e-9)
    assert poisson == pytest.approx(0.3, rel=1e-9)
    assert found.strength == pytest.approx(40e6 + pressure)
    assert found.first_crack == pytest.approx(4e6 + 36e6 * 0.7 / 1.9 + pressure)
    assert found.rate == pytest.approx(1.1 * RATE)
    assert found.has_peak

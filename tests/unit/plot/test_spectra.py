"""Spectra of the monitors."""

import h5py
import numpy as np
import pytest

from dembound.plot.record import plot_spectra
from dembound.plot.spectra import plot_fourier, plot_response, plot_transfer
from dembound.results.histories import read_histories
from dembound.spectra import fourier_spectrum, response_spectrum, slope, smoothed

COUNT, STEP = 400, 1e-3


@pytest.fixture(scope="module")
def known_run(small_run, tmp_path_factory):
    """The record of that run with other histories: a pulse at the front, half of it later at the back, and a twin."""
    path = tmp_path_factory.mktemp("known") / "run.h5"
    path.write_bytes(small_run.read_bytes())
    time = STEP * np.arange(COUNT)
    with h5py.File(path, "r+") as file:
        histories = file["histories"]
        histories.copy("back", "back.free_field")
        for name, at, gain in (("front", 0.1, 1.0), ("back", 0.2, 0.5), ("back.free_field", 0.2, 0.25)):
            x = (np.pi * 40.0 * (time - at)) ** 2
            pulse = gain * (1.0 - 2.0 * x) * np.exp(-x)
            columns = {"time": time, "velocity": np.outer(pulse, [1.0, -0.1, 0.0])}
            columns["displacement"] = np.zeros((COUNT, 3))
            for column, values in columns.items():
                histories[name][column].resize(len(values), axis=0)
                histories[name][column][...] = values
    return path


def lines_of(panel) -> dict:
    return {line.get_gid(): line for line in panel.lines if line.get_gid()}


def test_fourier_spectra_are_those_of_the_histories(known_run):
    front, back = plot_fourier([known_run]).axes
    velocity = read_histories(known_run, "velocity")["front"].values[:, 0]
    frequency, spectrum = fourier_spectrum(velocity, STEP)
    line = lines_of(front)["front"]
    expected = np.sqrt(smoothed(frequency, np.abs(spectrum) ** 2, line.get_xdata()))
    np.testing.assert_allclose(line.get_ydata(), expected)
    ratio = lines_of(back)["back.free_field"].get_ydata() / lines_of(back)["back"].get_ydata()
    np.testing.assert_allclose(ratio, 0.5, rtol=1e-6)
    assert front.figure.get_supylabel() == "Fourier amplitude of the velocity along x (m/s·s)"


def test_transfer_functions_are_ratios_to_a_monitor_or_a_twin(known_run):
    (panel,) = plot_transfer([known_run], reference="front").axes
    values = lines_of(panel)["back"].get_ydata()
    np.testing.assert_allclose(values[~np.isnan(values)], 0.5, rtol=1e-6)
    (panel,) = plot_transfer([known_run], component="y").axes  # to the twin, as it has one
    values = lines_of(panel)["back"].get_ydata()
    np.testing.assert_allclose(values[~np.isnan(values)], 2.0, rtol=1e-6)


def test_response_spectra_are_those_of_accelerations(known_run):
    (panel,) = plot_response([known_run], "y", ["front"]).axes
    (line,) = lines_of(panel).values()
    acceleration = slope(read_histories(known_run, "velocity")["front"].values[:, 1], STEP)
    periods = line.get_xdata()
    assert periods[[0, -1]] == pytest.approx([8 * STEP, COUNT * STEP])
    expected = response_spectrum(acceleration, STEP, periods[40:42]).pseudo_acceleration
    np.testing.assert_allclose(line.get_ydata()[40:42], expected)


HEIGHT, LENGTH = 0.8, 0.05  # m/s, s


def pulses_at(path, name, pulses, step=1e-4, last=0.5, odd=0.0):
    """A record of monitors with Hann pulses along x of these heights; the last sample is `odd` later than others."""
    time = np.append(np.arange(0.0, last, step), last + odd)
    with h5py.File(path, "w") as file:
        file.attrs["name"], file.attrs["size"] = name, [10.0, 1.0]
        for monitor, height in pulses.items():
            group = file.create_group(f"histories/{monitor}")
            group.attrs["position"] = group.attrs["requested"] = [1.0, 0.5]
            inside = (time > 0.1) & (time < 0.1 + LENGTH)
            velocity = np.zeros((len(time), 3))
            velocity[:, 0] = inside * 0.5 * height * (1.0 - np.cos(2.0 * np.pi * (time - 0.1) / LENGTH))
            velocity[:, 1] = 0.1 * velocity[:, 0]
            group["time"], group["velocity"] = time, velocity
    return path


def hann(frequency, height):
    """Spectrum of ½h(1 − cos 2πt/T) on 0…T: hT/2 · sin(πx)/[πx(1 − x²)], x = fT, without its poles at 0 and 1."""
    x = np.asarray(frequency) * LENGTH
    x = np.where(np.isclose(x, 0.0) | np.isclose(x, 1.0), x + 1e-7, x)
    return np.abs(0.5 * height * LENGTH * np.sin(np.pi * x) / (np.pi * x * (1.0 - x**2)))


@pytest.mark.parametrize("odd", [0.0, -3e-5])
def test_the_spectrum_is_that_of_the_pulse(tmp_path, odd):
    # Sums of a pulse that is twice differentiable alias below (Δt/T)² = 4e-6 of the peak; an odd last sample shortens
    # the interval of 5000 by 6e-9 of themselves, and interpolation costs (πΔt/T)²/2 = 2e-5 at most.
    panel = plot_spectra([pulses_at(tmp_path / "run.h5", "pulse", {"P": HEIGHT}, odd=odd)]).axes[0]
    (line,) = panel.lines
    frequency, amplitude = line.get_data()
    np.testing.assert_allclose(amplitude, hann(frequency, HEIGHT), atol=3e-5 * 0.5 * HEIGHT * LENGTH)

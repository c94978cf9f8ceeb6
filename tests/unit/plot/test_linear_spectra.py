"""Spectra are those of the recorded velocities, in m/s per Hz, up to where they have faded."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.record import plot_spectra

HEIGHT, LENGTH = 0.8, 0.05  # m/s, s


def record(path, name, pulses, step=1e-4, last=0.5, odd=0.0):
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
    panel = plot_spectra([record(tmp_path / "run.h5", "pulse", {"P": HEIGHT}, odd=odd)]).axes[0]
    (line,) = panel.lines
    frequency, amplitude = line.get_data()
    np.testing.assert_allclose(amplitude, hann(frequency, HEIGHT), atol=3e-5 * 0.5 * HEIGHT * LENGTH)
    assert panel.get_xlabel() == "frequency (Hz)"


def test_axes_end_where_all_spectra_are_below_a_hundredth_of_the_largest(tmp_path):
    weak = record(tmp_path / "a.h5", "weak", {"P": 0.005 * HEIGHT, "Q": 0.5 * HEIGHT})
    strong = record(tmp_path / "b.h5", "strong", {"P": HEIGHT})
    figure = plot_spectra([weak, strong])
    end = figure.axes[0].get_xlim()[1]
    peak = 0.5 * HEIGHT * LENGTH
    assert hann(end, HEIGHT) == pytest.approx(0.01 * peak, rel=0.2)
    assert (hann(np.linspace(end + 1.0, 500.0, 5000), HEIGHT) < 0.01 * peak).all()
    assert [[line.get_label() for line in panel.lines] for panel in figure.axes] == [["weak", "strong"], ["weak"]]


def test_the_component_can_be_chosen_and_a_monitor_at_rest_has_an_empty_panel(tmp_path):
    run = record(tmp_path / "run.h5", "pulse", {"P": HEIGHT, "Q": 0.0})
    panels = [plot_spectra([run], component).axes for component in (None, "x", "y")]
    np.testing.assert_allclose(
        [of.lines[0].get_ydata()[0] for of, _ in panels], 0.5 * LENGTH * HEIGHT * np.array([1.0, 1.0, 0.1]), rtol=1e-4
    )
    assert [len(rest.lines) for _, rest in panels] == [0, 0, 0]
    with pytest.raises(CaseError, match="has no monitors to show"):
        plot_spectra([record(tmp_path / "none.h5", "none", {})])

"""Spectra of the monitors."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.spectra import plot_fourier, plot_response, plot_transfer
from dembound.plot.table import columns_of
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
    assert set(lines_of(back)) == {"back", "back.free_field"}
    ratio = lines_of(back)["back.free_field"].get_ydata() / lines_of(back)["back"].get_ydata()
    np.testing.assert_allclose(ratio, 0.5, rtol=1e-6)
    assert front.figure.get_supylabel() == "Fourier amplitude of the velocity along x (m/s·s)"
    assert back.get_xlabel() == "frequency (Hz)"
    assert (front.get_xscale(), front.get_yscale()) == ("log", "log")
    (legend,) = front.figure.legends
    assert legend.get_texts()[-1].get_text() == "thin: not smoothed"


@pytest.mark.parametrize(
    ("draw", "what"),
    [
        (plot_fourier, "Fourier amplitude of the velocity (m/s·s)"),
        (plot_transfer, "amplitude over that of their free-field twins, velocity (–)"),
        (plot_response, "pseudo-acceleration, 5 % damping (m/s²)"),
    ],
)
def test_both_components_are_named_beside_their_panels_and_in_the_table(known_run, draw, what):
    figure = draw([known_run], "both", monitors=["back"])
    assert [panel.get_ylabel() for panel in figure.axes] == ["along x", "along y"]
    heads = [head for head, _ in columns_of(figure) if head.startswith("back, small")]
    assert heads == [f"back, small: {what}, along {axis}" for axis in "xy"]


def test_transfer_functions_are_ratios_to_a_monitor_or_a_twin(known_run):
    (panel,) = plot_transfer([known_run], reference="front").axes
    values = lines_of(panel)["back"].get_ydata()
    assert np.isnan(values).any()
    np.testing.assert_allclose(values[~np.isnan(values)], 0.5, rtol=1e-6)
    assert panel.texts[0].get_text().startswith("0.5 at ")
    heads = [head.split(": ")[0] for head, _ in columns_of(panel.figure) if head.startswith("back, ")]
    assert heads == ["back, small", "back, not smoothed, small"]
    (panel,) = plot_transfer([known_run], component="y").axes  # to the twin, as it has one
    values = lines_of(panel)["back"].get_ydata()
    np.testing.assert_allclose(values[~np.isnan(values)], 2.0, rtol=1e-6)
    assert panel.figure.get_supylabel() == "amplitude over that of their free-field twins, velocity along y (–)"


def test_response_spectra_are_those_of_accelerations(known_run):
    (panel,) = plot_response([known_run], "y", ["front"]).axes
    (line,) = lines_of(panel).values()
    acceleration = slope(read_histories(known_run, "velocity")["front"].values[:, 1], STEP)
    periods = line.get_xdata()
    assert periods[[0, -1]] == pytest.approx([8 * STEP, COUNT * STEP])
    expected = response_spectrum(acceleration, STEP, periods[40:42]).pseudo_acceleration
    np.testing.assert_allclose(line.get_ydata()[40:42], expected)
    assert panel.figure.get_suptitle() == "Response spectra of the monitors, from 8 ms on: eight samples in a period"


@pytest.mark.parametrize(
    ("draw", "keys", "problem"),
    [
        (plot_transfer, {"reference": "nowhere"}, "--reference: is nowhere, must be one of back, "),
        (plot_transfer, {"reference": "front", "monitors": ["front"]}, "--monitor: names only the monitor that is"),
        (plot_response, {"component": "rotation"}, "a response spectrum is of x or y"),
        (plot_fourier, {"quantity": "displacement"}, "nothing moves at these monitors"),
        (plot_fourier, {"monitors": ["nowhere"]}, "monitor: is nowhere, must be one of"),
    ],
)
def test_what_cannot_be_shown_is_said(known_run, draw, keys, problem):
    with pytest.raises(CaseError, match=problem):
        draw([known_run], **keys)


def test_twins_and_enough_samples_are_needed(known_run, small_run, run, copied):
    with pytest.raises(CaseError, match="these runs have no free-field twins"):
        plot_transfer([small_run])
    with copied(known_run) as file:
        for column in file["histories/front"].values():
            column.resize(15, axis=0)
    with pytest.raises(CaseError, match="monitor front: has 15 samples, a spectrum needs at least 16"):
        plot_fourier([run])

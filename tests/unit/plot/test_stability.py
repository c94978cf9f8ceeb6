"""Passes of a calibration."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.stability import plot_convergence
from dembound.results.datasets import describe

BETA = [0.5, 0.618, 0.7]
OUTGOING = [0.618, 0.567, 0.536]


def calibration(path, name, beta, outgoing):
    facts = {"boundary": "right", "wave": "p", "kind": "absorbing", "method": "ratio", "incident": 0.5}
    with h5py.File(path, "w") as file:
        describe(file, {"name": name, **facts})
        file["beta"], file["outgoing"] = np.array(beta), np.array(outgoing)
        file["ratio"] = np.array(outgoing) / 0.5
    return path


def test_peaks_and_factors_stand_against_the_pass(tmp_path):
    records = [
        calibration(tmp_path / "first.h5", "first", BETA, OUTGOING),
        calibration(tmp_path / "second.h5", "second", BETA[:1], OUTGOING[:1]),
    ]
    upper, lower = plot_convergence(records).axes
    first, second, incident = upper.lines
    np.testing.assert_array_equal(first.get_xdata(), [1, 2, 3])
    np.testing.assert_array_equal(first.get_ydata(), OUTGOING)
    np.testing.assert_array_equal(second.get_ydata(), OUTGOING[:1])
    np.testing.assert_array_equal(incident.get_ydata(), 0.5)
    np.testing.assert_array_equal(lower.lines[0].get_ydata(), BETA)
    with pytest.raises(CaseError, match="no passes"):
        plot_convergence([calibration(tmp_path / "calibration.h5", "empty", [], [])])

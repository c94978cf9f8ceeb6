"""Headers whose names and units are separated by blanks alone, and units that are not known."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.gauge.gauge_io import read_free_end
from dembound.gauge.reading.signal import Reading, read_signal

TIME = 1e-6 * np.arange(5.0)


def write(path, header):
    np.savetxt(path, np.column_stack([TIME, TIME]), header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "step", "size"),
    [
        ("time (s) velocity (mm/s)", 1.0, 1e-3),
        ("time (ms) free end (cm/s)", 1e-3, 1e-2),
        ("t v [km/s]", 1.0, 1e3),
        ("t[us] v[m/s]", 1e-6, 1.0),
        ("time velocity", 1.0, 1.0),
        ("(ms) (mm/s)", 1e-3, 1e-3),
    ],
)
def test_units_are_read(header, step, size, tmp_path):
    time, velocity = read_free_end(tmp_path / "gauge.txt", str(write(tmp_path / "end.txt", header)))
    np.testing.assert_allclose(time, step * TIME, rtol=1e-12)
    np.testing.assert_allclose(velocity, size * TIME, rtol=1e-12)


@pytest.mark.parametrize(
    ("header", "said"),
    [
        ("time (s) velocity (in/s)", "the header has values in in/s, must be m/s, cm/s, mm/s or km/s"),
        ("time (min) velocity (m/s)", "the header has times in min, must be s, ms, µs or ns; or --time-unit"),
    ],
)
def test_unknown_units_are_refused(header, said, tmp_path):
    with pytest.raises(CaseError, match=said):
        read_free_end(tmp_path / "gauge.txt", str(write(tmp_path / "end.txt", header)))


def test_a_stress_in_an_unknown_unit_is_not_taken_for_pascals(tmp_path):
    path = write(tmp_path / "gauge.txt", "time (s) stress (psi)")
    assert (read_signal(path).unit, read_signal(path, Reading(unit="MPa")).unit) == ("", "Pa")

"""Histories in the units they are shown in."""

import h5py
import numpy as np

from dembound.results.histories import entries, read_bands, read_histories


def test_accelerations_are_central_differences_of_the_velocity(small_run):
    history = read_histories(small_run, "acceleration")["front"]
    with h5py.File(small_run) as file:
        time, velocity = (file["histories/front"][name][:] for name in ("time", "velocity"))
    inner = (velocity[2:] - velocity[:-2]) / (time[2:] - time[:-2])[:, None]
    # times are whole multiples of a step, rounded: differences of theirs differ by 1e-13 of a step or less
    np.testing.assert_allclose(history.values[1:-1], inner, rtol=1e-9, atol=1e-9 * np.abs(inner).max())
    np.testing.assert_allclose(history.values[0], (velocity[1] - velocity[0]) / (time[1] - time[0]))


def test_bands_are_read_where_there_are_some(tmp_path):
    record = tmp_path / "run.h5"
    assert read_bands(record, "velocity") == {}
    with h5py.File(tmp_path / "estimate.h5", "w") as file:
        file["histories/a/time"] = [0.0, 1.0]
        file["histories/a/velocity/band"] = [[1.0, 2.0], [3.0, 4.0]]
        file["histories/b/time"] = [0.0, 1.0]
        file["histories/b/velocity/band"] = [[5.0, 6.0], [7.0, 8.0]]
        file["histories/b/velocity/corrected"] = [[9.0, 9.0], [9.0, 9.0]]
    found = read_bands(record, "velocity")
    np.testing.assert_array_equal(found["a"].half_width, [[1.0, 2.0], [3.0, 4.0]])
    assert found["a"].corrected is None
    np.testing.assert_array_equal(found["b"].corrected, 9.0)
    assert read_bands(record, "acceleration") == {}


def test_entries_of_a_summary_as_texts():
    estimate = {
        "monitors": {
            "a": {"velocity": {"of": {"rock": {"value": 0.05, "upper": 0.07}}, "by": {"grid": 0.03, "sides": 0.04}}}
        },
        "causes": {"sides": {"how": "companion", "words": "from a pair"}},
        "notes": ["a note"],
        "not_estimated": ["a gap"],
    }
    assert dict(entries(estimate)) == {
        "a, velocity": "of the rock 5 %, at most 7 % (sides 4 %, grid 3 %)",
        "sides": "companion, from a pair",
        "notes": "a note",
        "not estimated": "a gap",
    }

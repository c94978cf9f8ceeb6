"""Estimated errors beside a record: bands, and their sizes in words."""

import h5py
import numpy as np

from dembound.results.histories import entries, in_words, read_bands


def test_errors_in_words():
    words = ["< 0.1 %", "0.1 %", "2.5 %", "35 %", "127 %"]
    assert [in_words(share) for share in (9.9e-4, 1e-3, 0.0253, 0.351, 1.27)] == words


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

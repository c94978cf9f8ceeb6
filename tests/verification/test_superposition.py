"""Sums of responses are direct runs to rounding, also where an oblique wave enters a box of disks on all sides."""

import h5py
import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.errors import CaseError
from dembound.running import run_case
from dembound.running.recorded import recorded_case
from dembound.studies.library import Library, build_library, read_records, write_response

SPACING, COUNT = 1e-3, 27


@pytest.mark.slow
def test_a_record_at_an_angle_is_the_sum_of_its_triangles(tmp_path):
    tables = {key: table for key, table in SURROUNDED.items() if key != "outside"} | {
        "incident": {"type": "sv", "angle": 20.0, "wave": "quake"},
        "wave": {"quake": {"type": "ricker", "amplitude": 1.0, "frequency": 60.0}},
        "run": {"duration": 0.05},
    }
    library = Library(build_library(small(tables, "angle"), SPACING, tmp_path))
    # D/c_s: 1 m over 1000/√2 m/s or less, so more than one spacing of 1 ms
    assert library.lead == 2
    values = np.random.default_rng(1).standard_normal(COUNT)
    values[[0, 1, 2, -1]] = 0.0
    path = tmp_path / "noise.txt"
    np.savetxt(path, np.column_stack([SPACING * np.arange(COUNT), values]))
    (record,) = read_records([str(path)], library.inputs, library.clock)
    motion = write_response(library, record, tmp_path / "noise" / "run.h5")

    direct = run_case(recorded_case(tmp_path / "noise" / "run.h5"), tmp_path / "direct") / "run.h5"
    with h5py.File(direct) as run:
        for number, name in enumerate(library.monitors):
            history = run["histories"][name]
            np.testing.assert_array_equal(history["time"][:], library.time)
            both = np.hstack([history["displacement"][:], history["velocity"][:]])
            # rounding of 200 steps; a triangle cut at the beginning of a run, without the lead, leaves 1e-4
            assert (np.abs(motion[:, number] - both) <= 1e-12 * np.abs(both).max(axis=0)).all()

    values[2] = 1.0
    np.savetxt(path, np.column_stack([SPACING * np.arange(COUNT), values]))
    with pytest.raises(CaseError, match=r"it must be 0 up to 0\.002 s"):
        read_records([str(path)], library.inputs, library.clock)

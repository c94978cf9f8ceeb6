"""Records open by name, with their cracks and laws; files are replaced whole."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError, RecordError
from dembound.results.histories import read_side_history
from dembound.results.reader import (
    cracks_until,
    energy_of,
    history_of,
    open_record,
    side_energies_of,
    snapshot_of,
    snapshots_of,
)
from dembound.results.results import Results


def test_the_history_of_an_interrupted_run_ends_where_both_columns_do(small_run, tmp_path):
    path = tmp_path / "run.h5"
    path.write_bytes(small_run.read_bytes())
    with h5py.File(path, "r+") as file:
        file.attrs["complete"] = False
        file["histories/front/velocity"].resize(5, axis=0)
    with open_record(path) as file:
        time, velocity = history_of(file["histories/front"], "velocity")
        np.testing.assert_array_equal(time, file["histories/front/time"][:5])
    assert velocity.shape == (5, 3)


@pytest.mark.parametrize(
    ("column", "read"),
    [
        ("histories/front/velocity", lambda path, file: history_of(file["histories/front"], "velocity")),
        ("energy/kinetic", lambda path, file: energy_of(file)),
        ("energy/sides/left/absorbed", lambda path, file: side_energies_of(file)),
        ("boundaries/left/force", lambda path, file: read_side_history(path, "left")),
    ],
)
def test_numbers_that_are_not_finite_are_refused(small_run, tmp_path, column: str, read) -> None:
    path = tmp_path / "run.h5"
    for value in (np.nan, -np.inf):
        path.write_bytes(small_run.read_bytes())
        with h5py.File(path, "r+") as file:
            side = file["boundaries/left"]
            side.attrs["body_length"] = 2.5
            for name, width in (("force", 2), ("displacement", 3)):
                side[name] = np.zeros((5, width))
            side["time"] = np.arange(5.0)
            if column not in file:
                file[column] = np.zeros(5)
            file[column][3] = value
        reason = f"{column} has a number that is not finite in row 3"
        with pytest.raises(RecordError, match=reason), open_record(path) as file:
            read(path, file)


def test_more_than_ten_thousand_snapshots_are_in_the_order_of_time(long_run):
    with open_record(long_run) as file:
        first, last = snapshots_of(file)
        assert (first.name, last.name) == ("/snapshots/9999", "/snapshots/10000")
        assert first.attrs["time"] < last.attrs["time"]
        assert snapshot_of(file, -1) == last
    times = [each.attributes["time"] for each in Results(long_run).snapshots]
    assert times == sorted(times)


def test_cracks_are_those_up_to_a_time_that_time_included(cracked_run):
    with open_record(cracked_run) as file:
        times = file["cracks/time"][:]
        moment = times[len(times) // 2]
        found = cracks_until(file, moment)
        count = np.count_nonzero(times <= moment)
        for name, values in file["cracks"].items():
            np.testing.assert_array_equal(found[name], values[:count])


def ledger(path, **columns):
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file[f"energy/{name}"] = np.array(values)
    return path


def test_the_error_of_the_ledger_is_relative_to_all_that_was_supplied(tmp_path):
    path = tmp_path / "run.h5"
    for supplied, relative in (([0.0, 4.0, 4.0], [0.0, 0.25, 0.5]), ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0])):
        columns = {"time": [0.0, 1.0, 2.0], "error": [0.0, 1.0, 2.0], "supplied": supplied}
        with open_record(ledger(path, **columns)) as file:
            found = energy_of(file)
        assert found.pop("relative_error").tolist() == relative
        assert {name: values.tolist() for name, values in found.items()} == columns
    for columns in ({}, {"time": [], "outside": [], "load": [], "kinetic": [], "error": []}):
        ledger(path, **columns)
        with open_record(path) as file, pytest.raises(CaseError, match=r"run\.h5: has no entries in its energy ledger"):
            energy_of(file)

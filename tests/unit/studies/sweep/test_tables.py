"""The members of a sweep, their names, keys and groups, and its tables, read as a user would."""

import csv
import json

import h5py
import numpy as np
import pytest
from small_cases import GRAINS, small

from dembound.errors import CaseError
from dembound.results.folder import problem_of
from dembound.studies.sweep.members import ENERGY, LONGEST, Member, members_of, variations
from dembound.studies.sweep.perform import Outcome
from dembound.studies.sweep.tables import Swept, statistic, write_tables

SIDE = {"type": "free"}


@pytest.fixture
def swept(bar) -> Swept:
    """Two dampers with two seeds each, of which one failed and one was not done, and another side."""
    rows = [
        ({"packing.seed": 1, "run.safety": 0.5}, {"monitors.end.peak_velocity": 1.0, "energy.kinetic": 2.0}),
        ({"packing.seed": 2, "run.safety": 0.5}, {"monitors.end.peak_velocity": 3.0, "energy.kinetic": 6.0}),
        ({"packing.seed": 1, "run.safety": 0.9}, {"monitors.end.peak_velocity": 5.0}),
        ({"packing.seed": 2, "run.safety": 0.9}, "stalled, at 3 s"),
        ({"packing.seed": 1, "boundary.right": SIDE}, None),
    ]
    members = [Member(f"m{number}", changes, bar(), str(number)) for number, (changes, _) in enumerate(rows)]
    outcomes = [
        found if found is None else Outcome("", failure=found) if isinstance(found, str) else Outcome("", values=found)
        for _, found in rows
    ]
    return Swept(bar({"title": "β and $safety$"}), "run", members, outcomes)


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_tables_have_rows_of_members_and_groups_and_the_record_the_same_with_units(swept, tmp_path) -> None:
    write_tables(swept, tmp_path)
    rows = rows_of(tmp_path / "sweep.csv")
    assert [row["member"] for row in rows] == ["m0", "m1", "m2", "m3", "m4"]
    assert [row["state"] for row in rows] == ["done", "done", "done", "stalled, at 3 s", "not done"]
    assert [row["run.safety"] for row in rows] == ["0.5", "0.5", "0.9", "0.9", ""]
    assert json.loads(rows[4]["boundary.right"]) == SIDE
    assert [row["monitors.end.peak_velocity"] for row in rows] == ["1.0", "3.0", "5.0", "", ""]
    rows = rows_of(tmp_path / "statistics.csv")
    assert [(row["run.safety"], row["quantity"], row["unit"], row["count"], row["mean"]) for row in rows] == [
        ("0.5", "monitors.end.peak_velocity", "m/s", "2", "2.0"),
        ("0.5", "energy.kinetic", ENERGY, "2", "4.0"),
        ("0.9", "monitors.end.peak_velocity", "m/s", "1", "5.0"),
    ]
    # of 1 and 3: √2, and t(0.975) of one degree, tan(0.475π) = 12.70620, times √2/√2
    assert float(rows[0]["spread"]) == pytest.approx(np.sqrt(2.0), rel=1e-14)
    assert float(rows[0]["interval"]) == pytest.approx(np.tan(0.475 * np.pi), rel=1e-9)
    assert float(rows[0]["high"]) - float(rows[0]["low"]) == pytest.approx(2.0 * float(rows[0]["interval"]))
    assert (rows[2]["spread"], rows[2]["low"]) == ("", "")
    with h5py.File(tmp_path / "sweep.h5") as file:
        assert [text.decode() for text in file["members/name"][:]] == ["m0", "m1", "m2", "m3", "m4"]
        assert json.loads(file["members/changes"][4]) == {"packing.seed": 1, "boundary.right": SIDE}
        assert np.array_equal(file["values/energy.kinetic"][:], [2.0, 6.0, *[np.nan] * 3], equal_nan=True)
        assert file["values/energy.kinetic"].attrs["unit"].decode() == ENERGY
        inner = file["statistics/monitors.end.peak_velocity"]
        assert inner["mean"][:].tolist() == [2.0, 5.0]
        assert inner["count"][:].tolist() == [2, 1]


def test_the_interval_is_students() -> None:
    """The squared deviations of 2, 4, 4, 4, 5, 5, 7, 9 add to 32; t(0.975) of 7 degrees is 2.364624 (tables)."""
    found = statistic({}, "x", [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0])
    assert found.count == 8
    assert found.mean == 5.0
    assert found.spread == pytest.approx(np.sqrt(32.0 / 7.0), rel=1e-14)
    assert found.interval == pytest.approx(2.364624 * np.sqrt(32.0 / 7.0 / 8.0), rel=5e-7)  # of seven digits
    assert found.ends == (found.mean - found.interval, found.mean + found.interval)
    one = statistic({}, "x", [3.0])
    assert (one.mean, one.count) == (3.0, 1)
    assert np.isnan([one.spread, one.interval, *one.ends]).all()


def names(case, vary, together=False):
    members, _ = members_of(case, variations(vary, together), "run", "impedance")
    return [member.name for member in members]


def test_all_combinations_are_members_the_last_key_first_or_values_together(bar) -> None:
    vary = {"run.safety": [0.5, 0.9], "run.duration": [0.01, 0.02]}
    assert names(bar(), vary) == [f"safety={s},duration={d}" for s in (0.5, 0.9) for d in (0.01, 0.02)]
    assert names(bar(), vary, together=True) == ["safety=0.5,duration=0.01", "safety=0.9,duration=0.02"]
    with pytest.raises(CaseError, match=r"--together: .* run.safety 2 values, run.duration 1 value"):
        variations(vary | {"run.duration": [0.01]}, together=True)
    with pytest.raises(CaseError, match="--vary: is missing"):
        variations({}, False)
    # invalid ones are left out and equal ones count once
    members, left_out = members_of(bar(), variations({"run.safety": [0.5, 2.0, 0.5]}, False), "run", "impedance")
    assert [member.name for member in members] == ["safety=0.5"]
    assert [line.split(":")[0] for line in left_out] == ["safety=2"]


def test_names_are_those_of_folders_and_differ(bar) -> None:
    sides = [{"type": "free"}, {"type": "viscous", "beta_p": 0.5}, {"type": "viscous", "beta_p": 0.5 + 1e-9}]
    found = names(bar(), {"boundary.right": sides})
    assert found[:2] == ["boundary.right=free", "boundary.right=viscous-(beta_p-0.5)"]
    assert found[2].startswith("boundary.right=viscous-(beta_p-0.5)-")  # the same to six digits
    assert not [name for name in found if problem_of(name)]
    (long,) = names(bar(), {"title": ["a/b:" * 30]})
    assert problem_of(long) == ""
    assert len(long) <= LONGEST + 9


def test_keys_depend_on_results_alone(bar) -> None:
    changes = variations({"run.safety": [0.5]}, False)

    def key(case, action="run", method="impedance"):
        ((member,), _) = members_of(case, changes, action, method)
        return member.key

    same = key(bar({"title": "another", "sweep": {"processes": 7, "vary": {"run.safety": [0.5]}}}), method="ratio")
    assert key(bar()) == same  # the method is one of calibrations
    others = [key(bar({"run.duration": 0.011})), key(bar(), "calibrate"), key(bar(), "calibrate", "ratio")]
    assert len({key(bar()), *others}) == 4


def test_groups_are_the_changes_without_seeds() -> None:
    random = small(GRAINS)
    members, _ = members_of(random, variations({"packing.seed": [1, 2], "run.safety": [0.5]}, False), "run", "ratio")
    assert [member.group for member in members] == [{"run.safety": 0.5}] * 2

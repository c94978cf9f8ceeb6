"""Whose results a run may replace."""

from dataclasses import replace

import pytest
from small_cases import PUSHED, SPALLING, small

import dembound
from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.running import run_case
from dembound.running.recorded import recorded_case

SHORT = {"run.duration": 1e-4, "output": {"pictures": False}}


def of_file(name: str, tables: dict = SPALLING) -> Case:
    """A short case as from the file <name>.toml."""
    return replace(small(tables, changes=SHORT), name=name, origin=name)


def test_results_of_another_case_are_not_replaced(tmp_path) -> None:
    folder = run_case(of_file("a"), tmp_path)
    before = (folder / "run.h5").read_bytes()
    other = replace(of_file("b"), name="a")
    for case, said in (
        (other, "has results of case a, which this run of case b would replace"),
        (of_file("a", PUSHED), "has results of a case of bar, which this run of a case of disks would replace"),
    ):
        with pytest.raises(CaseError, match=said):
            run_case(case, tmp_path)
    assert (folder / "run.h5").read_bytes() == before
    folder.rename(tmp_path / "a.partial")  # as if it had been interrupted
    with pytest.raises(CaseError, match=r"a\.partial: has results of case a"):
        run_case(other, tmp_path)


def test_the_same_case_is_run_again_under_its_names_also_changed_and_from_its_record(tmp_path) -> None:
    named = replace(of_file("b"), name="a")
    run_case(named, tmp_path)
    run_case(dembound.change(named, {"run.duration": 2e-4, "load.hit.pressure": 1e6}), tmp_path)
    run_case(recorded_case(tmp_path / "a" / "run.h5"), tmp_path)
    again = dembound.change(of_file("b"), {}, name="a")
    run_case(again, tmp_path)
    assert recorded_case(tmp_path / "a" / "run.h5").origin == "b"

"""Shipped cases: listed, and copied with what they need."""

from pathlib import Path

import pytest

from dembound import shipped
from dembound.errors import CaseError
from dembound.kinds import load

ROOT = Path(__file__).parents[2]


def test_all_cases_of_the_repository_are_listed_with_their_titles() -> None:
    here = {path.relative_to(ROOT / "cases").with_suffix("").as_posix() for path in (ROOT / "cases").rglob("*.toml")}

    assert set(shipped.names()) == set(shipped.titles()) == here
    assert all(shipped.titles().values())


def test_a_copy_of_a_case_can_be_read_where_it_is(tmp_path) -> None:
    for number, name in enumerate(shipped.names()):
        copied = shipped.copy(name, tmp_path / str(number))
        assert copied[0].parent == tmp_path / str(number)
        assert load(copied[0]).name == name.rpartition("/")[2]


def test_a_group_is_copied_with_its_scripts_which_stay_executable(tmp_path) -> None:
    copied = shipped.copy("lu2016", tmp_path)

    assert {path.relative_to(tmp_path).as_posix() for path in copied} >= {"lu2016/run.sh", "lu2016/table1.csv"}
    source = ROOT / "cases" / "lu2016" / "run.sh"
    assert (tmp_path / "lu2016" / "run.sh").stat().st_mode == source.stat().st_mode
    assert "__pycache__" not in {path.name for path in (tmp_path / "lu2016").iterdir()}


def test_nothing_is_overwritten(tmp_path) -> None:
    (tmp_path / "spall_pulse.txt").write_text("precious")
    with pytest.raises(CaseError, match=r"spall_pulse\.txt: exists already; nothing was copied, give another folder"):
        shipped.copy("spall", tmp_path)

    assert [path.name for path in tmp_path.iterdir()] == ["spall_pulse.txt"]
    shipped.copy("lu2016", tmp_path)
    with pytest.raises(CaseError, match=r"exists already, together with \d+ more of the files to copy; nothing"):
        shipped.copy("lu2016", tmp_path)


def test_an_unknown_name_is_refused(tmp_path) -> None:
    with pytest.raises(CaseError) as caught:
        shipped.copy("zhou218", tmp_path)
    first, *_ = caught.value.problems

    assert first == 'NAME: is "zhou218", must be one of these (did you mean zhou2018?):'

"""Records open by name; files are replaced whole."""

import pytest

from dembound.errors import CaseError
from dembound.results import open_record, record_names, replacing, snapshot_of


def test_what_is_no_record_is_refused_by_name(tmp_path):
    text = tmp_path / "run.h5"
    text.write_text("not a record")
    for path in (text, tmp_path / "missing.h5"):
        with pytest.raises(CaseError, match=path.name):
            open_record(path)


@pytest.mark.parametrize(("number", "name"), [(0, "0000"), (1, "0001"), (-1, "0001"), (-2, "0000")])
def test_snapshots_go_by_number_from_either_end(small_run, number, name):
    with open_record(small_run) as file:
        assert snapshot_of(file, number) == file[f"snapshots/{name}"]


@pytest.mark.parametrize("number", [2, -3])
def test_a_missing_snapshot_is_refused_with_the_file_and_their_number(small_run, number):
    with open_record(small_run) as file, pytest.raises(CaseError, match=rf"run.h5: has no snapshot {number}, it has 2"):
        snapshot_of(file, number)


def test_names_are_the_cases_names(small_run, other_run):
    assert record_names([small_run, other_run]) == ["small", "other"]


def test_records_of_one_name_go_by_their_folders_or_their_paths(small_run, other_run, tmp_path):
    (tmp_path / "twin").mkdir()
    twin, sibling = tmp_path / "twin" / "run.h5", tmp_path / "twin" / "sibling.h5"
    for copy in (twin, sibling):
        copy.write_bytes(small_run.read_bytes())
    folder = small_run.parent.name
    assert record_names([small_run, other_run, twin]) == [folder, "other", "twin"]
    assert record_names([small_run, twin, sibling]) == [folder, str(twin), str(sibling)]


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")
    with replacing(path) as part:
        part.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")

    def write_half():
        with replacing(path) as part:
            part.write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]

"""Records open by name, with their cracks and laws; files are replaced whole."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError, RecordError
from dembound.files import replacing
from dembound.results.histories import read_side_history
from dembound.results.reader import (
    cracks_until,
    energy_of,
    history_of,
    is_line,
    laws_in_words,
    laws_of,
    open_record,
    place_in_words,
    record_names,
    side_energies_of,
    snapshot_of,
    snapshots_of,
    text_of,
)
from dembound.results.results import Results


def test_what_damage_raises_is_one_line_about_the_record(small_run, tmp_path):
    path = tmp_path / "run.h5"
    for damage in (
        lambda file: file.pop("particles"),
        lambda file: file["histories/front"].pop("time"),
        lambda file: file.attrs.pop("name"),
        lambda file: file["histories/front/time"].resize(3, axis=0),
    ):
        path.write_bytes(small_run.read_bytes())
        with h5py.File(path, "r+") as file:
            damage(file)
        with pytest.raises(RecordError) as caught:
            contents(path)
        assert str(caught.value).startswith(f"{path}: ")
        assert len(caught.value.problems) == 1


def contents(path):
    with open_record(path) as file:
        return file["particles/position"][:], file["histories/front/time"][:], file.attrs["name"]


def test_other_errors_are_passed_on(small_run):
    with pytest.raises(FileNotFoundError), open_record(small_run):
        Path("nowhere/else").read_text(encoding="utf-8")
    with pytest.raises(CaseError, match=r"^said$") as caught, open_record(small_run):
        raise CaseError(["said"])
    assert caught.value.exit_code == 2


def test_texts_may_be_of_fixed_length():
    assert [text_of(value) for value in ("β", "β".encode(), np.bytes_("β".encode()))] == ["β"] * 3


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
        ("histories/front/time", lambda path, file: history_of(file["histories/front"], "velocity")),
        ("energy/kinetic", lambda path, file: energy_of(file)),
        ("energy/sides/left/absorbed", lambda path, file: side_energies_of(file)),
        ("boundaries/left/force", lambda path, file: read_side_history(path, "left")),
        ("boundaries/left/displacement", lambda path, file: read_side_history(path, "left")),
        ("boundaries/left/time", lambda path, file: read_side_history(path, "left")),
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


def test_a_place_on_a_bar_is_one_number(small_run, spalled_run):
    with open_record(small_run) as disks, open_record(spalled_run) as bar:
        assert (is_line(disks.attrs["size"]), is_line(bar.attrs["size"])) == (False, True)
    assert place_in_words((2.4, 1.2), (10.0, 2.5)) == "(2.40, 1.20) m"
    assert place_in_words((0.8755, 0.0), (1.0, 0.0)) == "0.8755 m"


def test_snapshots_go_by_number_from_either_end(small_run):
    with open_record(small_run) as file:
        for number, name in ((0, "0000"), (1, "0001"), (-1, "0001"), (-2, "0000")):
            assert snapshot_of(file, number) == file[f"snapshots/{name}"]
        for number in (2, -3):
            with pytest.raises(CaseError, match=rf"run.h5: has no snapshot {number}, they are 0 to 1"):
                snapshot_of(file, number)


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
        assert 0 < count < len(times)
        for name, values in file["cracks"].items():
            np.testing.assert_array_equal(found[name], values[:count])
        assert len(cracks_until(file, -1.0)["position"]) == 0


def test_laws_come_with_the_times_they_began_at(small_run, cracked_run, tmp_path):
    with open_record(small_run) as file:
        assert laws_of(file) == [("elastic", 0.0)]
    with open_record(cracked_run) as file:
        first, (name, time) = laws_of(file)
        assert (first, name) == (("elastic", 0.0), "linearpbond")
        assert 0.002 <= time <= file["cracks/time"][0]  # no wave is sent before
    cut_off = tmp_path / "run.h5"
    h5py.File(cut_off, "w").close()
    with open_record(cut_off) as file:
        assert laws_of(file) == []
    assert laws_in_words([("linearpbond", 0.0)]) == "linearpbond law all through"
    both = [("elastic", 0.0), ("linearpbond", 0.01234)]
    assert laws_in_words(both) == "elastic law to 0.0123 s, then linearpbond"


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


def test_records_of_one_name_go_by_their_folders_or_their_paths(small_run, other_run, tmp_path):
    (tmp_path / "twin").mkdir()
    twin, sibling = tmp_path / "twin" / "run.h5", tmp_path / "twin" / "sibling.h5"
    for copy in (twin, sibling):
        copy.write_bytes(small_run.read_bytes())
    folder = small_run.parent.name
    assert record_names([small_run, other_run]) == ["small", "other"]
    assert record_names([small_run, other_run, twin]) == [folder, "other", "twin"]
    assert record_names([small_run, twin, sibling]) == [folder, str(twin), str(sibling)]


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")

    def write_half():
        with replacing(path) as part:
            part.write(b"half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_half()
    assert path.read_text() == "old"
    with replacing(path) as part:
        part.write(b"new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(FileNotFoundError) as refused, replacing(tmp_path / "nowhere" / "file"):
        pytest.fail("nothing can be written")
    assert refused.value.filename == str(tmp_path / "nowhere")


def test_parts_that_results_lack_are_named(tmp_path) -> None:
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file["snapshots/0000/velocity"] = np.zeros((2, 3))
    results = Results(tmp_path)
    assert results.snapshots[-1]["velocity"].shape == results.snapshots[:1][0]["velocity"].shape == (2, 3)
    assert len(list(results.snapshots)) == 1
    with pytest.raises(IndexError, match=r"run\.h5: has no snapshot 99, they are 0 to 0$"):
        results.snapshots[99]
    with pytest.raises(TypeError, match=r"results have no \['x'\]; their parts are attributes: histories, "):
        results["x"]

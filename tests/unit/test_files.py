"""No file that is written or read back leads out of its folder: links, pipes and huge files are refused in one line."""

import csv
import os
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from dembound.errors import RecordError
from dembound.files import copy, replacing_by_name
from dembound.plot.style import save
from dembound.results.checkpoint import Checkpoint
from dembound.results.committed import changed_file, new_file
from dembound.results.folder import Folder
from dembound.results.text_files import write_csv, write_json

STATE = Checkpoint({"version": "1"}, {"a": np.zeros(3)})


def by_name(path: Path) -> None:
    with replacing_by_name(path) as part:
        part.write_text("mesh")


def record(path: Path) -> None:
    with new_file(path) as file:
        file["a"] = 1.0


def change(path: Path) -> None:
    with changed_file(path) as file:
        file["b"] = 1.0


WRITERS = {
    "json": (lambda path: write_json(path, {}), ".part"),
    "table": (lambda path: write_csv(path, [["a"]]), ".part"),
    "picture": (lambda path: save(Figure(), path), ".part"),
    "mesh": (by_name, ".part"),
    "checkpoint": (STATE.write, ".part"),
    "copy": (lambda path: copy(Path(__file__), path), ".part"),
    "record": (record, ".new"),
    "changed record": (change, ".new"),
}


@pytest.fixture
def planted(tmp_path):
    """Puts a link, a link that leads nowhere, or a pipe at a path; afterwards its target must be as before."""
    target = tmp_path / "precious"
    target.write_text("precious")

    def plant(path: Path, kind: str) -> None:
        path.parent.mkdir(exist_ok=True)
        if kind == "pipe":
            os.mkfifo(path)
        else:
            path.symlink_to(target if kind == "link" else tmp_path / "none")

    yield plant
    assert target.read_text() == "precious"
    assert not (tmp_path / "none").exists()


def refused(act, path: Path) -> None:
    """An action ends with one line that names a path, and exit code 5."""
    with pytest.raises(RecordError) as found:
        act()
    (line,) = str(found.value).splitlines()
    assert line.startswith(f"{path}: is ")
    assert found.value.exit_code == 5


@pytest.mark.parametrize("kind", ["link", "nowhere", "pipe"])
@pytest.mark.parametrize("name", WRITERS)
def test_nothing_is_written_through_what_is_planted(name, kind, planted, tmp_path) -> None:
    write, ending = WRITERS[name]
    for place in ("file", f"file{ending}"):
        planted(tmp_path / kind / place, kind)
        refused(lambda: write(tmp_path / kind / "file"), tmp_path / kind / place)
        assert [path.name for path in (tmp_path / kind).iterdir()] == [place]
        (tmp_path / kind / place).unlink()
    write(tmp_path / kind / "file")


def test_removing_and_moving_do_not_enter_links(tmp_path) -> None:
    results, other = tmp_path / "results", tmp_path / "other"
    other.mkdir()
    (other / "run.h5").write_text("precious")
    for name in ("run", "run.partial"):
        (results / name).mkdir(parents=True)
        (results / name / "notes").symlink_to(other)
        (results / name / "run.h5").write_text(name)
    folder = Folder(results, "run")
    with folder.writing(anew=True) as folder_of_run:
        (folder_of_run / "run.h5").write_text("new")
        folder._old.mkdir()
        (folder._old / "notes").mkdir()
        (folder._old / "notes" / "mine").write_text("mine")
        with pytest.raises(Exception, match="has files that"):
            folder.finish()
    assert [path.name for path in other.iterdir()] == ["run.h5"]
    assert (other / "run.h5").read_text() == "precious"


def test_texts_that_spreadsheets_take_for_formulas_begin_with_an_apostrophe(tmp_path) -> None:
    row = ["=1+1", "@a", "-a", "+a", "\t=1", "-1.5", "+2", "a=1", -1.5, None, float("nan"), "-inf"]
    write_csv(tmp_path / "a.csv", [row])
    with (tmp_path / "a.csv").open(newline="") as file:
        (found,) = csv.reader(file)
    assert found == ["'=1+1", "'@a", "'-a", "'+a", "'\t=1", "-1.5", "+2", "a=1", "-1.5", "", "", "-inf"]

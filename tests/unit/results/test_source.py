"""A record and the case file it comes from: results of another file, a changed file, and a summary of another run."""

import json
import os
from pathlib import Path

import pytest
import tomli_w
from small_cases import SPALLING, small

import dembound
from dembound.errors import CaseError, RecordError
from dembound.results.summary import read_summary
from dembound.running import run_case
from dembound.running.unfinished import changes_since

SHORT = {"run.duration": 1e-4, "output": {"pictures": False}}


def written(folder: Path, **changes: float) -> Path:
    """The file a.toml of a short case in a folder."""
    folder.mkdir(exist_ok=True)
    path = folder / "a.toml"
    keys = {key.replace("__", "."): value for key, value in changes.items()}
    path.write_text(small(SPALLING, changes=SHORT | keys).text)
    return path


def test_results_of_a_file_of_the_same_name_in_another_folder_are_not_replaced(tmp_path) -> None:
    one, other = written(tmp_path / "one"), written(tmp_path / "other")
    results = tmp_path / "results"
    run_case(dembound.load(one), results)
    with pytest.raises(CaseError, match=r"has results of .*one.a\.toml, which this run of .*other.a\.toml"):
        run_case(dembound.load(other), results)
    run_case(dembound.load(written(tmp_path / "one", run__duration=2e-4)), results)  # the same file, changed
    one.unlink()
    run_case(dembound.load(other), results)  # the file has been moved


def test_a_case_file_that_has_changed_since_the_run_began_is_named_with_its_keys(tmp_path) -> None:
    case = written(tmp_path)
    folder = run_case(dembound.change(dembound.load(case), {"bar.density": 2600.0}), tmp_path)
    assert changes_since(folder) == []  # changed by an option, not in the file
    written(tmp_path, run__duration=2e-4)
    assert changes_since(folder) != []  # as bar.density is another one there
    written(tmp_path, bar__density=2600.0, run__duration=2e-4)
    assert changes_since(folder) == []  # when it ends is for --until
    written(tmp_path, bar__density=2400.0)
    (said,) = changes_since(folder)
    assert "has changed since the run began (bar.density); the case as it was goes on" in said
    os.remove(case)
    assert changes_since(folder) == []


def test_a_wave_file_that_has_changed_since_the_run_began_is_named(tmp_path) -> None:
    wave = tmp_path / "records" / "hit.txt"
    wave.parent.mkdir()
    wave.write_text("0 0\n1e-5 1\n2e-5 0\n")
    case = tmp_path / "a.toml"
    tables = SPALLING | {"wave": {"hit": {"type": "file", "path": "records/hit.txt"}}}
    tables["load"] = [load | {"wave": "hit"} for load in tables["load"]]
    case.write_text(tomli_w.dumps(tables | {"run": {"duration": 1e-4}, "output": {"pictures": False}}))
    folder = run_case(dembound.load(case), tmp_path)
    assert changes_since(folder) == []
    wave.write_text("0 0\n1e-5 2\n2e-5 0\n")
    (said,) = changes_since(folder)
    assert said.startswith(f"{wave}: has changed since the run began; its values as they were go on")


@pytest.mark.parametrize(("name", "value"), [("steps", 7), ("keys", {})])
def test_a_summary_of_another_run_is_refused(tmp_path, name: str, value: object) -> None:
    folder = run_case(small(SPALLING, changes=SHORT), tmp_path)
    summary = read_summary(folder)
    (folder / "summary.json").write_text(json.dumps(summary | {name: value}))
    with pytest.raises(RecordError, match=f"is of another run than run.h5 beside it: their {name} differ"):
        read_summary(folder)

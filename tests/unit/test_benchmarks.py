"""The benchmarks run with the present package, count contacts once, and mark changes only beyond their spread."""

import os
import runpy
import subprocess
import sys
import tomllib
from pathlib import Path

import compare_revisions
import pytest
import stepping
import traffic

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "benchmarks"
WORKERS = ("lammps_worker", "processes", "stepping")
"""Scripts that others start."""

COMMANDS = [
    path.stem
    for path in sorted(FOLDER.glob("*.py"))
    if path.stem not in WORKERS and "__main__" in path.read_text(encoding="utf-8")
]

SAID = {"compare_revisions": "| tunnel_a, elastic", "estimates": "| continuum A bench"}
"""What two print only of a scene that ran, as they go on after one that fails; so does `golden`, which notes errors."""


def ended(name: str, *arguments: str) -> object:
    """The exit code of a benchmark, run in this process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", [f"{name}.py", *arguments])
        patch.setattr(sys, "path", [*sys.path])
        patch.setattr(os, "environ", os.environ.copy())  # some set the number of threads
        with pytest.raises(SystemExit) as end:
            runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    return end.value.code


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_describe_themselves(name: str, capsys) -> None:
    assert not ended(name, "--help")
    assert f"benchmarks/{name}.py" in capsys.readouterr().out


def test_a_python_without_lammps_gives_one_line_and_its_exit_code(tmp_path, capsys) -> None:
    assert ended("lammps_bar", "--lammps-python", str(tmp_path / "python")) == 3
    said = capsys.readouterr().err
    assert said.startswith("LAMMPS is missing")
    assert said.count("\n") == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_the_smallest_measurement_of_each_runs(name: str, tmp_path) -> None:
    if name == "compare_revisions" and not (ROOT / ".git").exists():
        pytest.skip("no revisions")
    words = ["write", "golden.json"] if name == "golden" else []
    environment = os.environ | {"PYTHONPATH": str(ROOT), "NUMBA_NUM_THREADS": "1"}
    called = [sys.executable, str(FOLDER / f"{name}.py"), *words, "--small"]
    ended = subprocess.run(called, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    if ended.returncode == 3 and ended.stderr.startswith("LAMMPS is missing"):
        pytest.skip("LAMMPS is missing")
    assert ended.returncode == 0, ended.stderr
    assert SAID.get(name, "\n") in ended.stdout
    assert all('"error"' not in path.read_text(encoding="utf-8") for path in tmp_path.glob("*.json"))


def test_bytes_and_operations_of_a_step() -> None:
    def cost(copies: tuple[int, int], law: str = "elastic", held: str = "") -> list[float]:
        simulation = stepping.prepare(stepping.bar("A", *copies) + held, law)
        stepping.set_in_motion(simulation)
        simulation.advance(2)
        found = traffic.cost_of_step(simulation)
        return [simulation.scene.count, len(simulation.scene.assembly.pairs), found.bytes, found.flops]

    # two disks one by one: 12 operations a disk, 29 for each contact end; 140 bytes a disk, 8 an end
    assert cost((1, 2)) == [2, 1, 140 * 2 + 8 * 2, 12 * 2 + 29 * 2]
    # four disks in one block of eight slots: 15 operations a disk, 26 for each end, as no copy has all four contacts;
    # 120 bytes a slot, a byte for the block and one for each of the four masks
    assert cost((2, 2)) == [4, 4, 120 * 8 + 1 + 4, 15 * 4 + 26 * 8]
    # the same without y: 80 bytes a slot, 10 operations a disk, 13 for each end
    assert cost((2, 2), held="[motion]\nheld = ['y']\n") == [4, 4, 80 * 8 + 1 + 4, 10 * 4 + 13 * 8]
    # a lattice of 40 × 4 moves 120 bytes per slot at least, and each contact end takes 20 to 29 operations
    count, contacts, moved, operations = cost((40, 4))
    assert (count, contacts) == (160, 39 * 4 + 40 * 3)
    assert 120 * count <= moved
    assert 20 * 2 * contacts <= operations - 15 * count <= 29 * 2 * contacts
    # with a history each pair is computed once: in a row by 72 operations, alone by 91
    *_, moved, operations = cost((40, 4), "linearpbond, updated")
    assert 72 * contacts <= operations - 15 * count <= 91 * contacts
    assert moved >= 168 * count + 121 * contacts


@pytest.mark.parametrize(
    ("old", "new", "mark"),
    [
        ([1.0, 1.0, 1.0, 1.0], [0.5, 0.6, 0.6, 0.7], "faster"),
        ([1.0, 1.0, 1.0, 1.0], [1.2, 1.1, 1.3, 1.2], "slower"),
        ([1.0, 1.0, 1.0, 1.0], [1.04, 1.04, 1.03, 1.04], ""),  # less than 5 %
        ([1.0, 1.0, 1.0, 1.0], [0.7, 1.4, 0.8, 1.5], ""),  # 10 %, within the spread
        ([1.0, 2.0, 4.0, 8.0], [0.5, 1.0, 2.0, 4.0], "faster"),  # ratios of turns, not of medians
    ],
)
def test_only_changes_beyond_five_per_cent_and_the_spread_are_marked(old, new, mark) -> None:
    assert compare_revisions.verdict(old, new)["mark"] == mark


def test_every_single_edit_has_its_place_and_its_test() -> None:
    edits = tomllib.loads((FOLDER / "single_edits.toml").read_text(encoding="utf-8"))["edit"]
    package = {path.as_posix(): path.read_text(encoding="utf-8") for path in (ROOT / "dembound").rglob("*.py")}
    tests = [(path.stem, path.read_text(encoding="utf-8")) for path in (ROOT / "tests").rglob("test_*.py")]
    for edit in edits:
        counts = [text.count(edit["old"]) for path, text in package.items() if path.endswith(edit.get("file", ""))]
        assert (sum(counts), edit["new"] != edit["old"]) == (1, True), edit["name"]
        file, _, name = edit.get("test", "").partition(".")
        assert not file or any(stem == file and f"def {name}(" in text for stem, text in tests), edit["name"]

"""The benchmarks run with the present package, count contacts once, and mark changes only beyond their spread."""

import importlib
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "benchmarks"
COMMANDS = (
    "rates",
    "compare_revisions",
    "lammps_bar",
    "bar_rate",
    "estimate_bars",
    "continuum_rate",
    "pack_rate",
    "memory",
    "reductions",
    "reflection_packets",
    "estimates",
    "golden",
    "single_edits",
)

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the benchmarks measure processes as Unix does")


def python(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": f"{FOLDER}{os.pathsep}{ROOT}"}
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, env=environment)


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_describe_themselves(name: str) -> None:
    ended = python(FOLDER / f"{name}.py", "--help")

    assert ended.returncode == 0, ended.stderr
    assert f"benchmarks/{name}.py" in ended.stdout


def test_a_python_without_lammps_gives_one_line_and_its_exit_code(tmp_path) -> None:
    ended = python(FOLDER / "lammps_bar.py", "--lammps-python", str(tmp_path / "python"))

    assert ended.returncode == 3
    assert ended.stderr.startswith("LAMMPS is missing")
    assert ended.stderr.count("\n") == 1


def test_bytes_and_operations_of_a_step() -> None:
    script = """
import rates, stepping, traffic
for copies, law, held in (
    ((1, 2), "elastic", ""),
    ((2, 2), "elastic", ""),
    ((2, 2), "elastic", "[motion]\\nheld = ['y']\\n"),
    ((40, 4), "elastic", ""),
    ((40, 4), "linearpbond, updated", ""),
):
    simulation = stepping.prepare(stepping.bar("A", *copies) + held, law)
    stepping.set_in_motion(simulation)
    simulation.advance(2)
    cost = traffic.cost_of_step(simulation)
    print(simulation.scene.count, len(simulation.scene.assembly.pairs), cost.bytes, cost.flops)
"""
    ended = python("-c", script)
    assert ended.returncode == 0, ended.stderr
    two, four, held, lattice, pairs = ([float(word) for word in line.split()] for line in ended.stdout.splitlines())

    # two disks one by one: 12 operations a disk, 29 for each contact end; 140 bytes a disk, 8 an end
    assert two == [2, 1, 140 * 2 + 8 * 2, 12 * 2 + 29 * 2]
    # four disks in one block of eight slots: 15 operations a disk, 26 for each end, as no copy has all four contacts;
    # 120 bytes a slot, a byte for the block and one for each of the four masks
    assert four == [4, 4, 120 * 8 + 1 + 4, 15 * 4 + 26 * 8]
    # the same without y: 80 bytes a slot, 10 operations a disk, 13 for each end
    assert held == [4, 4, 80 * 8 + 1 + 4, 10 * 4 + 13 * 8]
    # a lattice of 40 × 4 moves 120 bytes per slot at least, and each contact end takes 20 to 29 operations
    count, contacts, moved, operations = lattice
    assert (count, contacts) == (160, 39 * 4 + 40 * 3)
    assert 120 * count <= moved
    assert 20 * 2 * contacts <= operations - 15 * count <= 29 * 2 * contacts
    # with a history each pair is computed once: in a row by 72 operations, alone by 91
    assert 72 * contacts <= pairs[3] - 15 * count <= 91 * contacts
    assert pairs[2] >= 168 * count + 121 * contacts


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
def test_only_changes_beyond_five_per_cent_and_the_spread_are_marked(old, new, mark, monkeypatch) -> None:
    monkeypatch.syspath_prepend(FOLDER)

    assert importlib.import_module("compare_revisions").verdict(old, new)["mark"] == mark


def test_every_single_edit_has_its_place_and_its_test() -> None:
    edits = tomllib.loads((FOLDER / "single_edits.toml").read_text(encoding="utf-8"))["edit"]
    package = {path.as_posix(): path.read_text(encoding="utf-8") for path in (ROOT / "dembound").rglob("*.py")}
    tests = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    for edit in edits:
        counts = [text.count(edit["old"]) for path, text in package.items() if path.endswith(edit.get("file", ""))]
        assert (sum(counts), edit["new"] != edit["old"]) == (1, True), edit["name"]
        assert f"def {edit.get('test', '').partition('.')[2]}" in tests, edit["name"]

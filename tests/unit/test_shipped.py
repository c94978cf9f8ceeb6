"""Shipped cases: listed, and copied with what they need."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

import dembound
from dembound import shipped
from dembound.errors import CaseError
from dembound.kinds import load
from dembound.running import plan

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


CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.skipif(os.name == "nt", reason="the scripts are for bash")
@pytest.mark.parametrize(
    ("script", "lacking", "said"),
    [
        ("zhou2018/section4.sh", "skfem", "needs the Python package scikit-fem"),
        ("zhou2018/section4.sh", "dembound", "needs the Python package dembound"),
        ("lu2016/run.sh", "dembound", ""),
    ],
)
def test_what_is_lacking_is_named_before_anything_runs(script: str, lacking: str, said: str, tmp_path) -> None:
    commands = tmp_path / "commands"
    commands.mkdir()
    tells, leaves = f'case "$2" in *{lacking}*) exit 1;; esac', f'touch "{tmp_path}/ran"'
    for name, text in (("python3", tells), ("dembound", leaves)):
        (commands / name).write_text(f"#!/bin/sh\n{text}\n")
        (commands / name).chmod(0o755)
    path = {"PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"}
    words = ["bash", CASES / script, tmp_path / "results"]
    ended = subprocess.run(words, env=os.environ | path, capture_output=True, text=True)
    assert ended.returncode == 1
    assert said in ended.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"commands"}


EXAMPLES_OF, PAGES = ROOT / "cases" / "gallery", ROOT / "docs" / "gallery"

_spec = importlib.util.spec_from_file_location("gallery_build", EXAMPLES_OF / "build.py")
build = sys.modules["gallery_build"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(build)

EXAMPLES = build.read_examples()


def test_the_gallery_has_all_cases_of_its_folder() -> None:
    assert all(each.commands[-1].startswith("dembound estimate results/") for each in EXAMPLES.values())
    assert len(EXAMPLES) >= 20
    assert set(EXAMPLES) == {path.stem for path in EXAMPLES_OF.glob("*.toml")} == set(build.read_measured())
    assert {path.stem for path in PAGES.glob("*.md")} == {*EXAMPLES, "index"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_case_can_be_run(name) -> None:
    """Without packing bricks, which takes seconds: those cases are only read and checked."""
    case = dembound.load(EXAMPLES_OF / f"{name}.toml")
    if "seed" not in EXAMPLES[name].tables:
        assert plan(case).scene is not None


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_page_is_that_of_its_case(name) -> None:
    example, measured = EXAMPLES[name], build.read_measured()[name]
    page = (PAGES / f"{name}.md").read_text(encoding="utf-8")

    assert page == example.page(measured)
    assert example.tables.startswith("title =")  # from there on the page includes the case
    assert f"{{literalinclude}} ../../cases/gallery/{name}.toml\n" in page
    pictures = ROOT / "docs" / "pictures"
    assert (pictures / f"gallery_{name}.png").stat().st_size < 250_000
    assert not example.has_movie or (pictures / f"gallery_{name}.gif").stat().st_size < 400_000


def test_the_index_is_that_of_the_examples() -> None:
    written = (PAGES / "index.md").read_text(encoding="utf-8")
    assert written == build.index(EXAMPLES, build.read_measured())


@pytest.mark.parametrize("name", build.QUICK)
def test_quick_examples_run_and_have_errors_that_are_estimated(name, tmp_path) -> None:
    case = dembound.change(
        dembound.load(EXAMPLES_OF / f"{name}.toml"), {"output.pictures": False, "output.snapshots": 0}
    )
    dembound.run(case, tmp_path)
    assert dembound.estimate(tmp_path / name).worst().monitor

"""The gallery: its cases can be run, and its pages are those that its script writes from them."""

import importlib.util
import sys
from pathlib import Path

import pytest

import dembound
from dembound.running import plan

ROOT = Path(__file__).parents[2]
CASES, PAGES = ROOT / "cases" / "gallery", ROOT / "docs" / "gallery"

_spec = importlib.util.spec_from_file_location("gallery_build", CASES / "build.py")
build = sys.modules["gallery_build"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(build)

EXAMPLES = build.read_examples()


def test_the_gallery_has_all_cases_of_its_folder() -> None:
    assert all(each.commands[-1].startswith("dembound estimate results/") for each in EXAMPLES.values())
    assert len(EXAMPLES) >= 20
    assert set(EXAMPLES) == {path.stem for path in CASES.glob("*.toml")} == set(build.read_measured())
    assert {path.stem for path in PAGES.glob("*.md")} == {*EXAMPLES, "index"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_case_can_be_run(name) -> None:
    """Without packing bricks, which takes seconds: those cases are only read and checked."""
    case = dembound.load(CASES / f"{name}.toml")
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
    case = dembound.change(dembound.load(CASES / f"{name}.toml"), {"output.pictures": False, "output.snapshots": 0})
    dembound.run(case, tmp_path)
    assert dembound.estimate(tmp_path / name).worst().monitor

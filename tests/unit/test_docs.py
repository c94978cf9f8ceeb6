"""The reference is that of the code: generated pages, keys, commands, datasets, and all that a run spends time on."""

import importlib
import re
import runpy
from pathlib import Path

import h5py
import pytest
import tomli_w
from scene_tables import point, pulse
from small_cases import SPALLING, SURROUNDED

from dembound import errors, kinds, laws
from dembound.casefile.json_schema import json_schema
from dembound.casefile.tables import Output
from dembound.cli import app
from dembound.cli.app import EXIT_CODES
from dembound.exact import cells_per_wavelength, courant_limit
from dembound.results import new_record
from dembound.running import SECTIONS, plan
from dembound.schemas import SCHEMAS

ROOT = Path(__file__).parents[2]
PAGES = runpy.run_path(str(ROOT / "docs" / "generate"))["PAGES"]


@pytest.mark.parametrize("name", PAGES)
def test_generated_pages_are_those_of_the_code(name) -> None:
    """`python docs/generate` writes them anew."""
    assert (ROOT / "docs" / name).read_text(encoding="utf-8") == PAGES[name]()


def test_every_table_key_and_type_stands_in_the_reference() -> None:
    """The keys come from the schema for editors, which does not use the list of tables in docs/generate."""
    page = (ROOT / "docs" / "reference" / "case_file.md").read_text(encoding="utf-8")
    tables = {key for schema in SCHEMAS for key in schema.keys if key != "title"}
    assert not [key for key in tables if not re.search(rf"^## `\[+{key}\]+`", page, flags=re.MULTILINE)]
    named = {f'`"{law.name}"`' for law in laws.TYPES}
    for name, table in json_schema(SCHEMAS)["$defs"].items():
        keys = table.get("properties", {}) if name not in {schema.case.__name__ for schema in SCHEMAS} else {}
        named |= {f"`{key}`" for key, value in keys.items() if "const" not in value}
        values = [each for value in keys.values() for each in (value.get("const"), *value.get("enum", ()))]
        named |= {f'`"{value}"`' for value in values if value}
    assert not [name for name in named if name not in page]


def test_every_command_stands_in_the_readme_or_a_page() -> None:
    pages = "\n".join(page.read_text() for page in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")))
    names = [command.name or command.callback.__name__ for command in app.registered_commands]
    assert not [name for name in names if not re.search(rf"dembound {name}\b", pages)]


def asked_for() -> dict[str, object]:
    """Keys of ``[output]`` with which everything is recorded: all switches on, rectangles inside the scene."""
    fields = Output.model_fields.items()
    switched = {name: True for name, field in fields if field.default is False}
    return switched | {
        name: [0.1, 0.2, 0.3, 0.4] for name, field in fields if str(field.annotation).startswith("tuple[float")
    }


DISKS = SURROUNDED | {"wave": pulse(0.02), "load": [point((0.0, 1e6), (1.5, 1.5))], "output": asked_for()}


@pytest.mark.parametrize("tables", [DISKS, SPALLING], ids=["disks", "bar"])
def test_every_dataset_of_a_record_stands_in_the_reference(tables, tmp_path) -> None:
    """The datasets of a new record of a case that requests all of them, and of its snapshots."""
    scene = plan(kinds.loads(tomli_w.dumps(tables))).scene
    found: set[str] = set(scene.in_snapshots)
    with h5py.File(tmp_path / "layout.h5", "w") as file:
        new_record._lay_out(file, scene, list(scene.edges), list(scene.edges))
        file.visititems(lambda name, item: found.add(name) if isinstance(item, h5py.Dataset) else None)
    page = re.sub(r"```.*?```", "", (ROOT / "docs" / "reference" / "results.md").read_text(), flags=re.DOTALL)
    rows = page.split("\n## `run.h5`\n")[1].split("\n## ")[0]
    words = {word for code in re.findall(r"`([^`]+)`", page) for word in re.findall(r"\w+", code)}
    named = [path.split("/") for path in found if not path.startswith("inputs/")]  # whose names are numbers
    assert not [path for path in named if path[-1] not in words or (path[1:] and f"\n- `{path[0]}/" not in rows)]


def test_exit_codes_of_help_and_errors_are_the_same():
    codes = " ".join(EXIT_CODES.split()).removeprefix("Exit codes: ").rstrip(".").split("; ")
    for code, meaning in (entry.split(" ", 1) for entry in codes):
        assert f"| {code} | {meaning}" in errors.__doc__


def test_spacings_per_wavelength_are_those_that_are_computed():
    text = (ROOT / "docs" / "evidence" / "dispersion.md").read_text()
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line[:3].strip("| ").isdigit()]
    assert [row[0] for row in rows] == ["1", "2", "3", "4", "5", "8", "10"]
    for row in rows:
        horizon, limit = int(row[0]), courant_limit(int(row[0]))
        asked = [(courant, of) for courant in (0.5, 0.9 * limit) for of in ("phase", "group")]
        assert row[1:] == [f"{limit:.3f}", *(f"{cells_per_wavelength(horizon, c, of=of):.1f}" for c, of in asked)]


def test_all_that_a_run_spends_time_on_stands_in_the_reference():
    text = (ROOT / "docs" / "reference" / "results.md").read_text()
    (line,) = (line for line in text.splitlines() if line.startswith("- `seconds`:"))
    assert not [section for section in SECTIONS if f"`{section}`" not in line]


PAGE_OF_FAILURES = (ROOT / "docs" / "evidence" / "where_methods_fail.md").read_text()

FAILURES = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in PAGE_OF_FAILURES.splitlines()
    if re.match(r"\| \d+ \|", line)
]
"""The rows of the page: number, what fails, threshold, how it shows, guard."""

MEASURED = re.findall(
    r"^(\d+)\. (.+?): (.+)$", (ROOT / "cases/where_methods_fail/tests.md").read_text(), flags=re.MULTILINE
)
"""Number of a failure, measured by, tests."""


def test_every_failure_is_numbered_measured_and_has_a_test() -> None:
    numbers = [str(number) for number in range(1, len(FAILURES) + 1)]
    assert [row[0] for row in FAILURES] == [number for number, _, _ in MEASURED] == numbers
    assert len(FAILURES) >= 22
    assert [len(list(filter(None, row))) for row in FAILURES] == [5] * len(FAILURES)
    for number, by, tested in MEASURED:
        for measured_by in re.findall(r"`([^`]+)`", by):
            module, _, function = measured_by.partition(".")
            if measured_by.endswith(".py"):
                assert (ROOT / "tests" / "verification" / measured_by).is_file()
            else:
                assert callable(getattr(importlib.import_module(module), function))
        tests = re.findall(r"`([^`]+)::([^`]+)`", tested)
        assert tests, number
        for file, name in tests:
            path = ROOT / file if "/" in file else ROOT / "tests" / "verification" / file
            assert f"\ndef {name}(" in path.read_text(), f"{file}: {name}"

"""The reference of the case file names every key there is."""

from pathlib import Path
from typing import get_args

import pytest

from dembound import errors
from dembound.boundaries import BoundaryTable
from dembound.case import load
from dembound.case.load import Load
from dembound.case.material import Material
from dembound.case.monitor import Monitor
from dembound.case.motion import Motion
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.case.static import Static, StaticSide
from dembound.cli.app import EXIT_CODES
from dembound.holes import HoleTable
from dembound.packings import PackingTable
from dembound.waves import WaveTable

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "docs" / "case_file.md"


def members(union):
    """The tables of an annotated union."""
    return get_args(get_args(union)[0])


UNIONS = [PackingTable, BoundaryTable, StaticSide, WaveTable, HoleTable]
TABLES = [
    Material,
    Motion,
    Static,
    Load,
    Monitor,
    Run,
    Output,
    *(table for union in UNIONS for table in members(union)),
]


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.__name__)
def test_every_key_stands_in_the_reference(table):
    text = REFERENCE.read_text()
    missing = [key for key in table.model_fields if f"`{key}`" not in text and f"`{key} =" not in text]
    assert not missing


@pytest.mark.parametrize("union", UNIONS)
def test_every_type_stands_in_the_reference(union):
    text = REFERENCE.read_text()
    for table in members(union):
        field = table.model_fields.get("type") or table.model_fields["pattern"]
        (name,) = get_args(field.annotation)
        assert f'"{name}"' in text


@pytest.mark.parametrize("path", sorted((ROOT / "cases").rglob("*.toml")), ids=lambda path: path.stem)
def test_every_case_that_is_shipped_is_valid(path):
    assert load(path).name == path.stem


def test_exit_codes_are_the_same_wherever_they_are_told():
    told = " ".join(EXIT_CODES.split())
    assert told in " ".join((ROOT / "README.md").read_text().split())
    for code, meaning in (entry.split(" ", 1) for entry in told.removeprefix("Exit codes: ").rstrip(".").split("; ")):
        assert f"| {code} | {meaning}" in errors.__doc__

"""The JSON schema takes what the reader takes, and refuses what one table shows to be wrong."""

import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from small_cases import rows

from dembound.casefile.json_schema import DRAFT, json_schema
from dembound.kinds import SCHEMAS
from dembound.starting import names, starting_point

SHIPPED = sorted((Path(__file__).parents[3] / "cases").rglob("*.toml"))


@pytest.fixture(scope="module")
def schema() -> dict:
    return json_schema(SCHEMAS)


@pytest.fixture(scope="module")
def problems(schema):
    """Lists what the schema finds wrong with a TOML text: where, and what."""
    validator = Draft202012Validator(schema)

    def find(text: str) -> list[tuple[str, str]]:
        return [(error.json_path, error.message) for error in validator.iter_errors(tomllib.loads(text))]

    return find


def test_it_is_a_schema_of_its_draft(schema) -> None:
    assert schema["$schema"] == DRAFT
    Draft202012Validator.check_schema(schema)


def test_shipped_cases_and_starting_points_are_valid(problems) -> None:
    for text in [*(path.read_text(encoding="utf-8") for path in SHIPPED), *map(starting_point, names())]:
        assert problems(text) == []


MISTAKES = r"""
long_bar | "viscous" | "vicious" | $.boundary.right.type | 'vicious' is not one of
long_bar | [boundary.right] | [boundary.rihgt] | $.boundary | 'rihgt' was unexpected
long_bar | amplitude = 0.5 | amplitude = "much" | $.wave.pulse.amplitude | not of type 'number'
long_bar | [[monitor]] | [monitor] | $.monitor | is not of type 'array'
tunnel | centre = | center = | $.hole[0] | 'center' was unexpected
excavation | type = "fixed" | type = "viscous" | $.static.boundary.bottom.type | is not one of
rock_bar | # [boundary.right] | [boundary.top] | $.boundary | 'top' was unexpected
"""


@pytest.mark.parametrize(("name", "old", "new", "place", "said"), rows(MISTAKES))
def test_a_mistake_is_found_where_it_is(problems, name: str, old: str, new: str, place: str, said: str) -> None:
    text = starting_point(name)
    assert old in text
    found = problems(text.replace(old, new, 1))
    assert any(where == place and said in what for where, what in found)


def test_units_stand_in_descriptions_and_null_nowhere(schema) -> None:
    run = schema["$defs"]["DiskRun"]["properties"]
    assert run["duration"]["description"] == "simulated time (s)"
    assert schema["$defs"]["Material"]["properties"]["pb_ten"]["type"] == "number"

    def holds_null(value) -> bool:
        if isinstance(value, dict):
            return value.get("type") == "null" or any(map(holds_null, value.values()))
        return value is None or (isinstance(value, list) and any(map(holds_null, value)))

    assert not holds_null(schema)

"""Messages about keys: no text of a library, advice on names of other codes, and the JSON schema for editors."""

import re
import tomllib
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from jsonschema import Draft202012Validator
from small_cases import FULL, PUSHED, SPALLING, problems_of, rows

from dembound.casefile.foreign import BY_NAME, NAMES, TYPE_OF
from dembound.casefile.json_schema import DRAFT, json_schema
from dembound.casefile.messages import allowed, counted, show
from dembound.kinds import SCHEMAS
from dembound.starting import names, starting_point

# of every TOML kind one that is wrong nearly everywhere
WRONG: list[Any] = [-7, -7.5, 10**30, float("nan"), True, "", "wrong", [], [1], ["x", "x"], {}, {"a": 1}]


def keys(table: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all keys in nested tables, tables included."""
    inner = table.items() if isinstance(table, dict) else enumerate(table) if isinstance(table, list) else ()
    return [path, *(below for key, value in inner for below in keys(value, (*path, key)))]


def replaced(table: Any, path: tuple[Any, ...], value: Any) -> Any:
    """A copy with the value at the path replaced."""
    if not path:
        return value
    copy = dict(table) if isinstance(table, dict) else list(table)
    copy[path[0]] = replaced(table[path[0]], path[1:], value)
    return copy


def problems(data: dict[str, Any]) -> list[str]:
    return problems_of(tomli_w.dumps(data))


PATHS = keys(FULL)[1:]
ONE_OF_EACH = {(path[0], type(reduce(getitem, path, FULL))): path for path in PATHS}.values()
"""One path to a value of each type in a table; the others are a slow sweep."""


@pytest.mark.parametrize(
    "path", [path if path in ONE_OF_EACH else pytest.param(path, marks=pytest.mark.slow) for path in PATHS], ids=str
)
def test_whatever_is_put_anywhere_is_answered_about_that_place(path: tuple[Any, ...]) -> None:
    refused = [found for value in WRONG if (found := problems(replaced(FULL, path, value)))]

    for found in refused:
        for line in found:
            assert re.match(r"[a-z_.0-9]+(\[\d+(, \w*)?\](\.\w+)?)?: \S", line)
            assert not re.search(r"pydantic|Input should|Field required|\bNone\b|value_error|https?:", line)
        # the table itself, or one that refers to its wave
        assert any(line.startswith(str(path[0])) or '"w"' in line for line in found)
    # a title may be any text and a time any positive number, but nothing takes half of the list
    assert len(refused) > len(WRONG) // 2


def test_values_are_shown_as_the_file_spells_them() -> None:
    assert [show(value) for value in (1.5, -2, True, 'a"ü', [1, "b"], {"a": 1}, float("nan"), 1e-5)] == [
        *("1.5", "-2", "true", '"a\\"ü"', '[1, "b"]', "a table", "nan", "1e-05")
    ]
    assert show("x" * 100) == '"' + "x" * 56 + "..."
    assert [counted(count, "disk") for count in (0, 1, 1200)] == ["0 disks", "1 disk", "1,200 disks"]
    assert allowed({"type": "string", "minLength": 1}) == "a text no shorter than 1"


DOCS = Path(__file__).parents[3] / "docs"
DISKS = PUSHED | {"static": {"stress": [-1e6, -1e6, 0.0]}}


def about(tables: dict, path: str, key: str) -> str:
    """The line about a foreign key in one of the tables."""
    changed = tables | ({path: tables.get(path, {}) | {key: 1.0}} if path else {key: 1.0})
    (line,) = problems(changed)
    assert line.startswith(f"{path}.{key}: " if path else f"{key}: ")
    return line.partition(": ")[2]


SAID = """
material | kn | write emod, Pa: the normal stiffness of a contact is k_n = emod
material | pb_ks | write pb_kratio = pb_kn/pb_ks
material | moment_contribution | write pb_mcf, 0 to 1, the share of the moment
material | etaRoll | write rr_fric, the largest moment over R̄ times the normal force
material | E | write young and poisson, of the body, or emod and pb_emod
static | damping | write damp
packing | radius_max | write radius: disks of pattern "A" are equal, those of "B" and "C" also have radius_ratio
bar | young | write youngs_modulus, Pa
run | mass_scaling | there is none: it would change the speed of waves
static | in_situ | write stress = [sxx, syy, sxy]
 | gravity | give [[load]] an acceleration
 | water | there is none: the ground is dry, without a water table, pore pressure or flow; see docs: tasks/slopes
 | water_table | there is none: the ground is dry
 | phreatic | there is none: the ground is dry
 | reservoir | there is none: no water stands on the ground, a dam is empty
material | pore_pressure | there is none: the ground is dry
static | pore pressure | there is none: the ground is dry
 | walls | [[wall]] has points and a velocity
bar | dx | write spacing, m
"""


@pytest.mark.parametrize(("path", "key", "said"), rows(SAID))
def test_a_name_of_another_code_is_answered_by_what_to_write(path: str, key: str, said: str) -> None:
    line = about(SPALLING if path == "bar" else DISKS, path, key)
    assert line.startswith(f"unknown {'key' if path else 'table'}; {said}")
    assert "did you mean" not in line


def test_only_a_near_key_is_guessed() -> None:
    for key in ("stiffnes_of_all", "colour", "kz", "dampened", "pbx"):
        line = about(DISKS, "material", key)
        assert line.startswith("unknown key; allowed: density, ")
        assert "did you mean" not in line
    near = {"densty": "density", "p_wavespeed": "p_wave_speed", "pb_tenn": "pb_ten", "kratoi": "kratio"}
    for key, meant in near.items():
        assert about(DISKS, "material", key).endswith(f"(did you mean {meant}?)")


def _keys(schema: Any) -> set[str]:
    """All keys of all tables of a schema, and all names of types."""
    if isinstance(schema, list):
        return set().union(*map(_keys, schema))
    if not isinstance(schema, dict):
        return set()
    own = {*schema.get("properties", {}), *(str(name) for name in (schema.get("const"), *schema.get("enum", ())))}
    return own.union(*map(_keys, schema.values()))


def test_every_advice_names_keys_and_types_that_there_are() -> None:
    known = _keys(json_schema(SCHEMAS))
    for advice in NAMES.values():
        for key, text in advice:
            assert key == "" or key in known
            assert text
            for named in re.findall(r"\bwrite (\w+)", text):
                assert named in known, text
            for page in re.findall(r"see docs: (\S+)", text):
                assert (DOCS / f"{page}.md").is_file()
    assert set(TYPE_OF.values()) <= known
    assert len(BY_NAME) == sum(len(names.split()) for names in NAMES)  # no name has two answers


SHIPPED = sorted((Path(__file__).parents[3] / "cases").rglob("*.toml"))


@pytest.fixture(scope="module")
def schema() -> dict:
    return json_schema(SCHEMAS)


@pytest.fixture(scope="module")
def wrong(schema):
    """Lists what the schema finds wrong with a TOML text: where, and what."""
    validator = Draft202012Validator(schema)

    def find(text: str) -> list[tuple[str, str]]:
        return [(error.json_path, error.message) for error in validator.iter_errors(tomllib.loads(text))]

    return find


def test_it_is_a_schema_of_its_draft(schema) -> None:
    assert schema["$schema"] == DRAFT
    Draft202012Validator.check_schema(schema)


def test_shipped_cases_and_starting_points_are_valid(wrong) -> None:
    for text in [*(path.read_text(encoding="utf-8") for path in SHIPPED), *map(starting_point, names())]:
        assert wrong(text) == []


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
def test_a_mistake_is_found_where_it_is(wrong, name: str, old: str, new: str, place: str, said: str) -> None:
    text = starting_point(name)
    assert old in text
    found = wrong(text.replace(old, new, 1))
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

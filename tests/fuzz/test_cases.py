"""Whatever a case file contains, it is a case that can be planned, or each mistake is one line.

Cases are made from the JSON schema of all tables, and by changing keys of sound cases: to values that the schema allows
for a key of this name, to numbers, texts and lists at the limits of their types, to keys of other names, or to none.
"""

import tomllib
import warnings
from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st
from small_cases import FULL, GRAINS, PUSHED, SURROUNDED, Tables

from dembound import kinds
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.casefile.json_schema import json_schema
from dembound.errors import CONTROL, CaseError, DemboundError
from dembound.motion.kind import echoes
from dembound.running import plan, warnings_before
from dembound.starting import names, starting_point

SCHEMA = json_schema(kinds.SCHEMAS)

MOST_DISKS, MOST_IN_BRICK, MOST_CELLS = 20_000, 300, 20_000
"""Largest numbers of disks, nodes and steps with which a case is planned; larger cases are only read."""

NUMBERS = (
    *(0, 0.0, -0.0, 1, 2, 3, -1, -1.0, 0.5, 1e-9, 1e-3, 1e3, 1e6, 1e9, 1e19, 9e18, 1e-30, 1e30, 9.9e-31, 1.1e30),
    *(5e-324, 1e-300, 1e-150, 1e150, 1e300, 1.7976931348623157e308, float("inf"), float("-inf"), float("nan")),
    *(2**31, 2**63 - 1, 2**63, 10**19, 10**400, -(10**400)),
)
TEXTS = (
    *("", "a", "auto", "fixed", "periodic", "elastic", "../a", "/dev/zero", "a\x00b", "\x1b[31m", "a\nb", "\u2028"),
    *("[/bold]", ":smile:", "中文", "$x^{$", "a" * 5000, "a.b." * 100),
)
LISTS = ([], [[]], {}, [{}], [1], [1.0, 2.0], [0.0, 0.0, 1.0, 1.0], ["a", "b"], [1e19, 1e19], [{}, 1])


def nested(depth: int) -> list[Any]:
    """Lists within lists."""
    value: list[Any] = []
    for _ in range(depth):
        value = [value]
    return value


LIMITS = st.one_of(
    *map(st.sampled_from, (NUMBERS, TEXTS, LISTS)), st.booleans(), st.dates(), st.sampled_from((5, 40)).map(nested)
)


def of_schema(schema: Mapping[str, Any]) -> st.SearchStrategy[Any]:
    """Values that a JSON schema allows; of numbers without limits those of common size."""
    if "$ref" in schema:
        return st.deferred(lambda: of_schema(SCHEMA["$defs"][schema["$ref"].rsplit("/", 1)[-1]]))
    if "const" in schema:
        return st.just(schema["const"])
    if "enum" in schema:
        return st.sampled_from(schema["enum"])
    if "allOf" in schema:  # a table of one of several types
        return st.one_of([of_schema(each["then"]) for each in schema["allOf"]])
    if "anyOf" in schema:
        return st.one_of([of_schema(each) for each in schema["anyOf"]])
    return OF_TYPE[schema.get("type", "object")](schema)


def _numbers(schema: Mapping[str, Any]) -> st.SearchStrategy[float]:
    low = max(schema.get("minimum", -1e12), schema.get("exclusiveMinimum", -1e12))
    high = min(schema.get("maximum", 1e12), schema.get("exclusiveMaximum", 1e12))
    powers = st.floats(-12.0, 12.0).map(lambda power: 10.0**power)
    plain = st.sampled_from([0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0])
    return st.one_of(plain, powers, powers.map(lambda x: -x)).filter(lambda x: low <= x <= high)


def _lists(schema: Mapping[str, Any]) -> st.SearchStrategy[list[Any]]:
    if "prefixItems" in schema:
        return st.tuples(*map(of_schema, schema["prefixItems"])).map(list)
    return st.lists(of_schema(schema["items"]), max_size=2)


def _tables(schema: Mapping[str, Any]) -> st.SearchStrategy[dict[str, Any]]:
    keys, required = schema.get("properties", {}), schema.get("required", ())
    inner = {key: of_schema(value) for key, value in keys.items()}
    table = st.fixed_dictionaries(
        {key: inner[key] for key in required if key in inner},  # conditions name keys of other schemas
        optional={key: inner[key] for key in inner if key not in required},
    )
    if not isinstance(others := schema.get("additionalProperties"), Mapping):
        return table
    named = st.dictionaries(st.sampled_from(["push", "shake", "hit"]), of_schema(others), max_size=2)
    return st.builds(lambda first, second: first | second, table, named)


OF_TYPE: dict[str, Callable[[Mapping[str, Any]], st.SearchStrategy[Any]]] = {
    "number": _numbers,
    "integer": lambda schema: st.integers(schema.get("minimum", 0), 20),
    "boolean": lambda schema: st.booleans(),
    "string": lambda schema: st.sampled_from(["push", "shake", "hit", "front", "a"]),
    "array": _lists,
    "object": _tables,
}


def _keys(schema: Any) -> dict[str, list[Any]]:
    """The schemas of all keys of all tables, by name."""
    found: dict[str, list[Any]] = {}
    if isinstance(schema, list | dict):
        for key, value in schema.get("properties", {}).items() if isinstance(schema, dict) else ():
            found.setdefault(key, []).append(value)
        for inner in schema.values() if isinstance(schema, dict) else schema:
            for key, values in _keys(inner).items():
                found.setdefault(key, []).extend(values)
    return found


KEYS = {key: st.one_of([of_schema(value) for value in values]) for key, values in _keys(SCHEMA["$defs"]).items()}
"""Allowed values of the keys of each name, in any table."""


HOLLOW: Tables = FULL | {
    "run": {"duration": 0.01},
    "hole": [{"name": "tunnel", "type": "circle", "centre": [5.0, 2.0], "radius": 0.4}],
    "load": [*FULL["load"], {"name": "blast", "pressure": 1e5, "hole": "tunnel", "wave": "w"}],
    "material": {key: value for key, value in FULL["material"].items() if key != "locked_in"},
    "motion": {},
    "boundary": {
        "left": {"type": "free_field"},
        "right": {"type": "viscoelastic_input", "wave_p": "w", "distance": 3.0},
        "bottom": {"type": "viscous_input", "wave_s": "s"},
    },
}
CHOICES: Tables = GRAINS | {
    "material": {"density": 2500.0, "emod": 1e9, "pb_emod": 1e9},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "chart": {"vary": {"packing.seed": [0, 1]}, "choice": [{"name": "fine", "set": {"packing.radius": 0.2}}]},
    "sweep": {"action": "calibrate", "processes": 2, "vary": {"packing": {"seed": "1:3"}}},
}
WAVED: Tables = SURROUNDED | {
    "incident": {"type": "sv", "angle": 20.0, "wave": "ramp", "point": [0.0, 0.0]},
    "wave": {"ramp": {"type": "constant", "amplitude": 0.1, "rise": 0.05, "start": 0.01}},
    "output": {"history_interval": 1e-3, "side_interval": 1e-3, "energy_interval": 1e-3, "snapshots": 2},
    "outside": {"order": 4, "element": 3.0, "accuracy": 1e-2, "margin": 1, "layers": 2, "reflection": 1e-3}
    | {"shift": 0.3, "delay": 0.1, "damping": 0.1},
    "run": {"duration": 0.02, "safety": 0.8, "checkpoint": 10.0, "until": "silent"}
    | {"silent_level": 1e-2, "silent_for": 0.005},
}
SOUND = [HOLLOW, CHOICES, WAVED, PUSHED, *map(tomllib.loads, map(starting_point, names()))]


def places(table: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all keys and list positions."""
    inner = table.items() if isinstance(table, dict) else enumerate(table) if isinstance(table, list) else ()
    return [path for key, value in inner for path in ((*place, key), *places(value, (*place, key)))]


def value_at(table: Any, path: Sequence[Any]) -> Any:
    """The value at a path."""
    for key in path:
        table = table[key]
    return table


@st.composite
def changed_cases(draw: st.DrawFn) -> dict[str, Any]:
    """Sound cases with one to three changes."""
    case = deepcopy(draw(st.sampled_from(SOUND)))
    for _ in range(draw(st.integers(1, 3))):
        *path, last = draw(st.sampled_from(places(case)))
        _change(draw, value_at(case, path), last)
    return case


def _change(draw: st.DrawFn, parent: Any, key: Any) -> None:
    """Change the value at a key of a table, or at a position of a list."""
    what = draw(st.sampled_from(["allowed", "allowed", "scaled", "limit", "gone", "renamed", "twice"]))
    value = parent[key]
    if what == "allowed" and key in KEYS:
        parent[key] = deepcopy(draw(KEYS[key]))
    elif what == "scaled" and isinstance(value, float):
        parent[key] = value * draw(st.sampled_from([-1.0, 0.0, 0.1, 0.5, 1.5, 2.0, 10.0, 1e-6, 1e6]))
    elif what == "gone":
        del parent[key]
    elif what == "renamed" and isinstance(parent, dict):
        parent[draw(st.sampled_from(["", "a.b", f"{key}s", "a\nb", "\x1b", "[/bold]", *KEYS]))] = parent.pop(key)
    elif what == "twice" and isinstance(parent, list):
        parent.append(deepcopy(value))
    else:
        parent[key] = deepcopy(draw(LIMITS))


def is_small(case: Case) -> bool:
    """Whether the case is planned within a second."""
    if isinstance(case, BarCase):
        return case.bar.cells <= MOST_CELLS
    assert isinstance(case, DiskCase)
    brick = getattr(case.packing, "brick", (0.0, 0.0))
    return case.packing.about(case.packing.extent) <= MOST_DISKS and case.packing.about(brick) <= MOST_IN_BRICK


def answered(data: Mapping[str, Any], folder: Path) -> bool:
    """Whether a case can be planned; if not, every line about it must be one, and no warning may be issued."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            case = kinds.loads(tomli_w.dumps(data), folder)
            if is_small(case):
                planned = plan(case)
                facts = dict([*planned.kind.facts(planned.scene, planned.time_step), *echoes(planned)])
                texts = [*warnings_before(planned), *facts.values()]
                assert not any(CONTROL.search(text) for text in texts)
        except DemboundError as error:
            lines = error.problems if isinstance(error, CaseError) else [str(error)]
            assert lines
            for line in lines:
                assert line
                assert not CONTROL.search(line)
                assert not any(word in line for word in ("Input should", "pydantic", "Traceback"))
            return False
    return True


@pytest.mark.parametrize("count", [100, pytest.param(3000, marks=pytest.mark.slow)])
def test_a_changed_case_is_planned_or_answered_in_lines(count: int, sweep, tmp_path: Path) -> None:
    planned = []

    @sweep(count)
    @given(changed_cases())
    def each(data: dict[str, Any]) -> None:
        planned.append(answered(data, tmp_path))

    each()
    assert 0.05 * len(planned) < sum(planned) < 0.95 * len(planned)  # else the changes are too large, or none

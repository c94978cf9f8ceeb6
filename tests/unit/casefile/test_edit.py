"""Texts of cases with keys changed: they parse to the tables requested, and all other lines stand byte for byte."""

import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Any

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from dembound.casefile.edit import commented, edited, rewritten
from dembound.casefile.keys import Place, lines_of, statements_of
from dembound.casefile.tables import Chart, Sweep, range_of

ODD = """\
#:schema ./dembound.schema.json
title = "odd"   # shown above pictures

# The ground.
[ground]   # all of it
size = [ 300.0,   # along x
         300.0 ]  # along y
  [boundary.left]
  type = "free"
  # reflects

  [boundary.right]
  type = "viscous"   # absorbs
  beta_p = 0.71_38

# Gauges.
[[monitor]]
name = "a"
position = [1.0, 2.0]

# The second.
[[monitor]]
position = [3.0, 4.0]
name = "b"

# Others.
[outside]
cfl.of.layers = 0.5
note = '''
[no.header] # no comment
'''
load = [
    {name = "x", force = [1.0, 0.0]},  # pushed
    {name = "y"},                      # not
]
"""


def leaves(data: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """All values that are no table and no list of tables, with their places."""
    if isinstance(data, Mapping):
        for key, inner in data.items():
            yield from leaves(inner, (*place, key))
    elif isinstance(data, list) and data and all(isinstance(each, Mapping) for each in data):
        for index, inner in enumerate(data):
            yield from leaves(inner, (*place, index))
    else:
        yield place, data


def other(value: Any) -> Any:
    """Another value of the same kind."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, str):
        return value + '"x'
    return [*value, 1.5] if isinstance(value, list) else -value - 1


def put(data: Any, place: Place, value: Any) -> None:
    for key in place[:-1]:
        data = data[key]
    data[place[-1]] = value


def test_comments_above_a_key_replace_their_kind() -> None:
    text = "[a]\n  # mine\n  # found: 1\n  x = 1  # kept\n[b]\nc = {d = 1}"
    once = commented(text, "a.x", ["# found: 2", "# found: 3"], "# found:")

    assert once == text.replace("  # found: 1\n", "  # found: 2\n  # found: 3\n")
    assert commented(once, "a.x", ["# found: 1"], "# found:") == text
    assert commented("[b]\r\nc = {d = 1}", "b.c.d", ["# e"], "# e") == "[b]\r\n# e\r\nc = {d = 1}"
    with pytest.raises(KeyError):
        commented(text, "a.z", [], "#")


def test_line_ends_and_a_missing_last_one_remain() -> None:
    for text, changes, expected in (
        ("[a]\r\nx = 1 # c\r\n", {"a.y": 2, "a.x": 3}, "[a]\r\nx = 3 # c\r\ny = 2\r\n"),
        ("a = 1", {"a": 2}, "a = 2"),
        ("a = 1", {"b": 2}, "a = 1\nb = 2\n"),
        ("# top\n[t]\n", {"a": 1}, "# top\na = 1\n\n[t]\n"),
        ("", {"a.b": {}}, "[a.b]\n"),
        (ODD, {"boundary.right.beta_p": 0.7138, "run": None, "monitor.a.name": "a"}, ODD),
    ):
        assert edited(text, changes) == expected


KEYS = st.sampled_from(["a", "b", "name", "size", "c d", "é.x"])
PLAIN = st.one_of(
    st.booleans(),
    st.integers(-5, 5),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=5),
    st.lists(st.integers(0, 3), max_size=3),
)
TABLES = st.recursive(
    st.dictionaries(KEYS, PLAIN, max_size=3),
    lambda inner: st.dictionaries(KEYS, st.one_of(PLAIN, inner, st.lists(inner, max_size=3)), max_size=4),
    max_leaves=12,
)


def quoted(key: str) -> str:
    return key if key.isascii() and key.isalnum() else f'"{key}"'


def inline(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{quoted(key)} = {inline(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip("\n")


def layout(data: Mapping[str, Any], draw: Any, place: tuple[str, ...] = ()) -> list[str]:
    """Lines of a table in any of the forms that TOML has, with comments and blank lines."""
    lines, sections = [], []
    for key, value in data.items():
        name = ".".join(map(quoted, (*place, key)))
        many = isinstance(value, list) and value and all(isinstance(each, dict) for each in value)
        form = draw(st.sampled_from(["inline", "dotted", "section", "lines"]))
        if form == "section" and isinstance(value, dict):
            sections += ["", f"# about {name}", f"[{name}]  # here", *layout(value, draw, (*place, key))]
        elif form == "section" and many:
            for each in value:
                sections += [f"[[{name}]]", *layout(each, draw, (*place, key)), "", "# next"]
        elif form == "dotted" and isinstance(value, dict) and value:
            lines += [f"  {quoted(key)} . {quoted(inner)} = {inline(each)} # dot" for inner, each in value.items()]
        elif form == "lines" and isinstance(value, list):
            lines += [f"{quoted(key)} = [ # open", *(f"  {inline(each)}, # one" for each in value), "]"]
        else:
            lines += [f"{quoted(key)}={inline(value)}", *draw(st.sampled_from([[], [""], ["# below"]]))]
    return [*lines, *sections]


@given(st.data())
@settings(deadline=None, max_examples=100, derandomize=True)
def test_any_layout_is_edited_to_any_other_tables(data: st.DataObject) -> None:
    before = data.draw(TABLES)
    requested = deepcopy(before) if data.draw(st.booleans()) else data.draw(TABLES)
    for place, value in list(leaves(before))[: data.draw(st.integers(0, 3))]:
        if requested == before or data.draw(st.booleans()):
            try:
                put(requested, place, other(value))
            except (KeyError, TypeError, IndexError):
                continue  # which the other tables do not have
    text = "\n".join(["# top", *layout(before, data.draw)]) + data.draw(st.sampled_from(["", "\n"]))
    assert tomllib.loads(text) == before

    new = rewritten(text, requested)

    assert repr_of(tomllib.loads(new)) == repr_of(requested)
    kept = [line for each in untouched(text, before, requested) for line in each]
    rest = iter(new.split("\n"))
    assert all(line in rest for line in kept)


def repr_of(value: Any) -> Any:
    """Tables as sorted texts, which differ for 1, 1.0 and true."""
    if isinstance(value, Mapping):
        return {key: repr_of(inner) for key, inner in value.items()}
    return [repr_of(each) for each in value] if isinstance(value, list) else repr(value)


def untouched(text: str, before: Any, requested: Any) -> Iterator[list[str]]:
    """The lines of the keys outside lists of tables that have the value requested."""
    lines = lines_of(text)
    for each in statements_of(lines):
        if each.kind == "header" or any(isinstance(key, int) for key in each.place):
            continue
        old, new = before, requested
        for key in each.place:
            old, new = old[key], new.get(key) if isinstance(new, Mapping) else None
        if repr_of(old) == repr_of(new):
            yield [line.rstrip("\n") for line in lines[each.begin : each.end]]


def test_ranges_include_both_ends_and_other_values_are_none() -> None:
    ranges = {"1:4": [1, 2, 3, 4], "7:7": [7], "-2:2:2": [-2, 0, 2], "0:10:4": [0, 4, 8]}
    assert {text: range_of(text) for text in ranges} == ranges
    for value in ("1", "1:", "1:2:3:4", "1.5:2", "a:b", 3, [1, 2], True):
        assert range_of(value) is None
    for text in ("4:1", "1:4:0", "1:1000000"):
        with pytest.raises(ValueError, match=text):
            range_of(text)


@pytest.mark.parametrize("table", [Chart, Sweep])
def test_lists_are_found_by_dotted_key(table) -> None:
    found = table(vary={"packing": {"seed": "1:3", "radius": [0.25]}, "run.safety": [0.5, 0.9]})
    assert found.vary == {"packing.seed": [1, 2, 3], "packing.radius": [0.25], "run.safety": [0.5, 0.9]}


@pytest.mark.parametrize("values", [0.5, [], "many", "3:1"])
def test_what_is_no_list_is_refused(values) -> None:
    with pytest.raises(ValidationError, match=r"must have a list of values|range without a number"):
        Sweep(vary={"run.safety": values})

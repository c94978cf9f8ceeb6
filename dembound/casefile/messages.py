"""One plain line per mistake from pydantic's errors: ``table.key: what is wrong, what is allowed``."""

import difflib
import json
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from dembound.casefile.foreign import own_type, translated

LIMITS = {
    "greater_than": "greater than {gt:g}",
    "greater_than_equal": "at least {ge:g}",
    "less_than": "less than {lt:g}",
    "less_than_equal": "at most {le:g}",
}
"""Mistakes of a value that has the right type."""

ALIKE = 0.75
"""Least similarity of two spellings of one name: a wrong letter in four, or two letters exchanged in five."""

KINDS = {
    *("float_type", "int_type", "bool_type", "string_type", "tuple_type", "literal_error"),
    *("missing", "too_short", "too_long", "string_too_short", "dict_type", "model_type"),
}
"""Mistakes whose message lists all allowed values."""


def describe(error: ValidationError, path: str, raw: object, schema: Mapping[str, Any]) -> list[str]:
    """Describe the mistakes in one table.

    Parameters
    ----------
    error
        The error raised by the validation of the table.
    path
        The table's place in the file, such as ``boundary.left``.
    raw
        The table as it was read.
    schema
        JSON schema of the expected value: a table, tables distinguished by a key, or a plain value.
    """
    return list(_described(error.errors(include_url=False), path, raw, schema, schema.get("$defs", {})))


def _described(
    details: Sequence[ErrorDetails], path: str, raw: object, schema: Mapping[str, Any], shared: Mapping[str, Any]
) -> Iterator[str]:
    """The mistakes in one table, see `describe`; shared : the schemas that others refer to."""
    if not isinstance(raw, Mapping) or not {"properties", "discriminator"} & schema.keys():
        own = details[0]["ctx"]["error"] if details[0]["type"] == "value_error" else None
        yield f"{path}: {own or f'is {show(raw)}, must be {allowed(schema)}'}"
        return
    keys, others = schema.get("properties", {}), {}
    if "discriminator" in schema:
        selector, variants = schema["discriminator"]["propertyName"], schema["discriminator"]["mapping"]
        if details[0]["type"].startswith("union_tag"):
            named = {key for place in variants.values() for key in shared[place.rsplit("/", 1)[-1]]["properties"]}
            yield from (f"{path}.{key}: {unknown('key', key, sorted(named))}" for key in raw if key not in named)
            found = f"is {show(raw[selector])}" if selector in raw else "is missing"
            yield f"{path}.{selector}: {found}, must be {_one_of(variants)}{_meant(raw.get(selector), variants)}"
            return
        others = {name: shared[place.rsplit("/", 1)[-1]]["properties"] for name, place in variants.items()}
        keys = others.pop(raw[selector])
        for detail in details:
            detail["loc"] = detail["loc"][1:]  # without the variant
    by_key: dict[str, list[ErrorDetails]] = {}
    for detail in details:
        by_key.setdefault(str(detail["loc"][0]) if detail["loc"] else "", []).append(detail)
    for key, about in by_key.items():
        inner = _table_at(keys.get(key, {}), shared)
        if inner and isinstance(raw.get(key), Mapping):
            about = _about_table(about, keys[key])
            yield from _described(about, f"{path}.{key}", raw[key], inner, shared)
            continue
        row = shared.get(keys.get(key, {}).get("items", {}).get("$ref", "").rsplit("/", 1)[-1])
        if row and isinstance(raw.get(key), list) and all(len(detail["loc"]) > 1 for detail in about):
            yield from _in_rows(f"{path}.{key}", about, raw[key], row, shared)
        else:
            yield from _lines(path, key, about, raw, keys, others)


def _about_table(details: list[ErrorDetails], schema: Mapping[str, Any]) -> list[ErrorDetails]:
    """The mistakes in the table at a key, by places within it; of a key that takes other values, too, those alone."""
    options = [each for each in schema.get("anyOf", ()) if each.get("type") != "null"]
    if len(options) > 1:
        name = next(each["$ref"].rsplit("/", 1)[-1] for each in options if "$ref" in each)
        details = [detail for detail in details if detail["loc"][1] == name]
    for detail in details:
        detail["loc"] = detail["loc"][2 if len(options) > 1 else 1 :]
    return details


def _table_at(schema: Mapping[str, Any], shared: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The schema of the table that is the value of a key of this schema, which may be optional; None for others."""
    for each in (schema, *schema.get("anyOf", ())):
        if found := shared.get(each.get("$ref", "").rsplit("/", 1)[-1]):
            return found if "properties" in found else None
    return None


def _in_rows(
    path: str,
    details: Sequence[ErrorDetails],
    rows: Sequence[object],
    row: Mapping[str, Any],
    shared: Mapping[str, Any],
) -> Iterator[str]:
    """The mistakes in a list of tables within a table; row : the schema of one of them."""
    by_row: dict[str | int, list[ErrorDetails]] = {}
    for detail in details:
        by_row.setdefault(detail["loc"][1], []).append(detail)
        detail["loc"] = detail["loc"][2:]
    for index, (place, raw) in enumerate(zip(places(path, rows), rows, strict=True)):
        if index in by_row:
            yield from _described(by_row[index], place, raw, row, shared)


def places(key: str, tables: Iterable[object]) -> list[str]:
    """The places of the tables of a list as they were read, such as ``monitor[1, top]``, counted from 1."""
    found = []
    for number, table in enumerate(tables, start=1):
        name = table.get("name") if isinstance(table, Mapping) else None
        found.append(f"{key}[{number}, {name}]" if isinstance(name, str) else f"{key}[{number}]")
    return found


def _lines(
    path: str,
    key: str,
    details: list[ErrorDetails],
    raw: Mapping[str, Any],
    keys: Mapping[str, Any],
    others: Mapping[str, Collection[str]],
) -> Iterator[str]:
    """The lines about one key, or about the table as a whole when the key is empty.

    raw : the table; keys : the schemas of its allowed keys; others : the keys of the other types of this table.
    """
    first = details[0]
    if first["type"] == "value_error":
        for line in str(first["ctx"]["error"]).splitlines():
            yield _join(path, key, line, keys)
    elif first["type"] == "extra_forbidden":
        yield f"{path}.{key}: {_stray(key, keys, others)}"
    elif key not in raw:
        yield f"{path}.{key}: is missing, must be {allowed(keys[key])}"
    elif any(detail["type"] == "finite_number" for detail in details):
        yield f"{path}.{key}: is {show(raw[key])}, must be finite"
    elif len(details) == 1 and first["type"] in LIMITS and len(first["loc"]) == 1:
        limit = LIMITS[first["type"]].format(**first.get("ctx", {}))
        yield f"{path}.{key}: is {show(raw[key])}, must be {limit}"
    elif first["type"] in LIMITS or first["type"] in KINDS:
        meant = _meant(raw[key], keys[key].get("enum", ()))
        yield f"{path}.{key}: is {show(raw[key])}, must be {allowed(keys[key])}{meant}"
    else:
        yield f"{path}.{key}: is {show(raw[key])}; {first['msg']}"


def _stray(key: str, keys: Collection[str], others: Mapping[str, Collection[str]]) -> str:
    """Message that a table has no such key, with the other types that have it."""
    having = [show(name) for name, known in others.items() if key in known]
    return f"is for {', '.join(having)}; allowed here: {', '.join(keys)}" if having else unknown("key", key, keys)


def _meant(value: object, names: Collection[str]) -> str:
    """The name meant by a foreign or mistyped one, in brackets after a blank; empty if there is none."""
    if not isinstance(value, str):
        return ""
    own = own_type(value, names)
    return f' (here "{own}")' if own else did_you_mean(value, [name for name in names if isinstance(name, str)])


def _join(path: str, key: str, message: str, keys: Iterable[str]) -> str:
    """Put the place before a table's own message, which may start with the key concerned: ``key: …``."""
    about, colon, rest = message.partition(": ")
    if not key and colon and about.partition("[")[0] in keys:
        return f"{path}.{about}: {rest}"
    return f"{path}.{key}: {message}" if key else f"{path}: {message}"


def unknown(what: str, name: str, known: Collection[str]) -> str:
    """Message for an unknown name: the key to use for a name from another code, or the known names."""
    if what in ("key", "table") and (instead := translated(name, known)):
        return f"unknown {what}; {instead}"
    return f"unknown {what}; allowed: {choices(name, known)}"


def choices(name: str, known: Collection[str]) -> str:
    """The known names, and the one that is most similar to `name`."""
    return ", ".join(known) + did_you_mean(name, known)


def did_you_mean(name: str, known: Collection[str]) -> str:
    """The name most similar to `name`, in brackets after a blank; empty if none is similar."""
    alike = difflib.get_close_matches(name, known, n=1, cutoff=ALIKE)
    return f" (did you mean {alike[0]}?)" if alike else ""


def counted(count: int, noun: str) -> str:
    """A number of things in words: ``1 disk``, ``1,200 disks``."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def numbered(key: str, tables: Iterable[Any]) -> Iterator[tuple[str, Any]]:
    """The valid tables of a list, each with its place, such as ``monitor[1, top]``; invalid ones are None."""
    for number, table in enumerate(tables, start=1):
        if table:
            yield f"{key}[{number}{f', {table.name}' if table.name else ''}]", table


def show(value: object) -> str:
    """A value as written in the case file; tables and long values are shortened."""
    if isinstance(value, Mapping):
        return "a table"
    text = repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= 60 else text[:57] + "..."


def corners(left: float, bottom: float, right: float, top: float) -> str:
    """Two corners of a box (m) as text, without the rounding errors of whole bricks: ``[0, 0] to [10, 5] (m)``."""
    return f"[{left:.10g}, {bottom:.10g}] to [{right:.10g}, {top:.10g}] (m)"


def allowed(schema: Mapping[str, Any]) -> str:
    """The values a JSON schema allows, in words: ``a number greater than 0 (s)``."""
    unit = schema.get("unit", "1")
    return _kind(schema) + ("" if unit == "1" else f" ({unit})")


def _kind(schema: Mapping[str, Any]) -> str:
    if "anyOf" in schema:
        return " or ".join(_kind(option) for option in schema["anyOf"] if option.get("type") != "null")
    if "const" in schema:
        return show(schema["const"])
    if "enum" in schema:
        return _one_of(schema["enum"])
    if schema.get("type") == "array":
        return _list(schema)
    kinds = {"number": "a number", "integer": "a whole number", "boolean": "true or false", "string": "a text"}
    return kinds.get(schema.get("type", ""), "a table") + _limits(schema)


def _one_of(values: Iterable[object]) -> str:
    return "one of " + ", ".join(show(value) for value in values)


def _list(schema: Mapping[str, Any]) -> str:
    items = schema.get("prefixItems")
    if items:
        return f"a list of {len(items)} values, each {_kind(items[0])}"
    return f"a list of values, each {_kind(schema['items'])}"


def _limits(schema: Mapping[str, Any]) -> str:
    words = {
        "exclusiveMinimum": "greater than",
        "minimum": "no less than",
        "exclusiveMaximum": "less than",
        "maximum": "no more than",
        "minLength": "no shorter than",
    }
    limits = [f"{word} {schema[key]:g}" for key, word in words.items() if key in schema]
    return " " + " and ".join(limits) if limits else ""

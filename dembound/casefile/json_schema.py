"""A JSON schema (draft 2020-12) of the case file, with which editors complete and check it.

It contains the rules for single keys: names, types, units, limits, defaults. `dembound check` also checks rules between
keys and tables.

Where a table has one of several types, ``if`` and ``then`` choose the type, so that editors mark the mistake itself.
With ``oneOf`` they would report the whole table as invalid. Completions are taken from an additional ``anyOf``, which
allows everything.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import TypeAdapter, ValidationError

from dembound.casefile.model import WAVE, Schema

DRAFT = "https://json-schema.org/draft/2020-12/schema"
IDENTIFIER = "urn:dembound:case-file"
"""The key that identifies a JSON file as this schema."""

TITLE = {"type": "string", "description": "one line for pictures and reports"}

Json = dict[str, Any]


def json_schema(schemas: Sequence[Schema]) -> Json:
    """The schema of case files of several kinds; the first kind whose tables occur in the file is used."""
    made, shared = TypeAdapter.json_schemas(
        [(id(kind), "validation", kind) for schema in schemas for kind in _kinds(schema)]
    )
    definitions = {name: _table(table) for name, table in shared.get("$defs", {}).items()}
    tables = {key: _one_of_types(table) for (key, _), table in made.items()}
    cases = {schema.case.__name__: _case(schema, tables, definitions) for schema in schemas}
    places = [_place(name) for name in cases]
    chosen: Json = places[-1]
    for schema, place in reversed([*zip(schemas[:-1], places[:-1], strict=True)]):
        chosen = {"if": {"anyOf": [{"required": [mark]} for mark in schema.marks]}, "then": place, "else": chosen}
    return {
        "$schema": DRAFT,
        "$id": IDENTIFIER,
        "title": "dembound case",
        "description": "A case of dembound: waves in bonded disks or in bars of rock. SI units.",
        "type": "object",
        **chosen,
        "anyOf": [*places, {}],
        "$defs": cases | definitions,
    }


def _kinds(schema: Schema) -> list[TypeAdapter[Any]]:
    """All types that are validated in files of a kind."""
    staged = [kind for pair in schema.staged.values() for kind in pair]
    return [*schema.tables.values(), *schema.lists.values(), *schema.optional.values(), *staged, schema.side, WAVE]


def _case(schema: Schema, tables: Mapping[int, Json], definitions: Json) -> Json:
    """A whole file of one kind; tables : by the identity of their validators. Adds the definitions it refers to.

    Keys that a table needs are required unless every entry of the list that may complete it gives them.
    """
    of = {key: tables[id(kind)] for key, kind in (*schema.tables.items(), *schema.optional.items())}
    of["boundary"] = _sides(schema, "side", tables[id(schema.side)], definitions)
    definitions["wave"] = tables[id(WAVE)]
    of["wave"] = {"type": "object", "description": "the waves, by name", "additionalProperties": _place("wave")}
    for key, kind in schema.lists.items():
        of[key] = {"type": "array", "items": tables[id(kind)]}
    for key, (kind, side) in schema.staged.items():
        of[key] = tables[id(kind)]
        table = definitions[of[key]["$ref"].rsplit("/", 1)[-1]]
        table["properties"]["boundary"] = _sides(schema, f"{key}_side", tables[id(side)], definitions)
    case: Json = {
        "type": "object",
        "description": f"a case of {schema.noun}",
        "properties": {key: TITLE if key == "title" else of[key] for key in schema.keys},
        "required": [key for key, kind in schema.tables.items() if _is_needed(kind)],
        "additionalProperties": False,
    }
    for key, entries in schema.completing.items():
        needed = definitions[of[key]["$ref"].rsplit("/", 1)[-1]].pop("required")
        case["required"].remove(key)
        case["if"] = {"properties": {entries: {"items": {"required": needed}}}, "required": [entries]}
        case["else"] = {"properties": {key: {"required": needed}}, "required": [key]}
    return case


def _sides(schema: Schema, name: str, side: Json, definitions: Json) -> Json:
    """The table of sides, any of which may be absent; the types of a side are a definition of their own."""
    definitions[f"{schema.case.__name__}_{name}"] = side
    return {
        "type": "object",
        "description": "the boundaries at the sides; an absent side is free",
        "properties": dict.fromkeys(schema.sides, _place(f"{schema.case.__name__}_{name}")),
        "additionalProperties": False,
    }


def _place(name: str) -> Json:
    """A reference to a definition."""
    return {"$ref": f"#/$defs/{name}"}


def _is_needed(kind: TypeAdapter[Any]) -> bool:
    """Whether a table has required keys."""
    try:
        kind.validate_python({})
    except ValidationError:
        return True
    return False


def _table(table: Json) -> Json:
    """The definition of one type of table; the key that distinguishes types is always required."""
    table = _plain(table)
    distinguishing = [key for key, value in table["properties"].items() if "const" in value]
    table["required"] = sorted({*table.get("required", ()), *distinguishing})
    table["properties"] = {key: _value(value) for key, value in table["properties"].items()}
    return table


def _one_of_types(table: Json) -> Json:
    """A table, which may be of one of several types distinguished by a key."""
    if "discriminator" not in table:
        return _plain(table)
    key, places = table["discriminator"]["propertyName"], table["discriminator"]["mapping"]
    return {
        "type": "object",
        "properties": {key: {"enum": list(places)}},
        "required": [key],
        "allOf": [
            {"if": {"properties": {key: {"const": name}}, "required": [key]}, "then": {"$ref": place}}
            for name, place in places.items()
        ],
        "anyOf": [*({"$ref": place} for place in places.values()), {}],
    }


def _value(value: Json) -> Json:
    """The allowed values of a key, with the unit in the description, and without null, which TOML does not have."""
    value = _plain(value)
    options = [option for option in value.pop("anyOf", ()) if option.get("type") != "null"]
    if len(options) > 1:
        value["anyOf"] = options
    for option in options if len(options) == 1 else ():
        value = {**option, **value}
    if value.get("default", ...) is None:
        del value["default"]
    value.pop("means", None)
    unit = value.pop("unit", "1")
    if unit != "1" and "description" in value:
        value["description"] += f" ({unit})"
    return value


def _plain(value: Json) -> Json:
    """A schema without titles, as they only repeat the key."""
    return {key: inner for key, inner in value.items() if key != "title"}

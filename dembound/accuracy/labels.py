"""Names of choices: keys and values of a case in words."""

from collections.abc import Mapping
from typing import Any

from dembound.casefile import Case
from dembound.table import DISCRIMINATORS, Table


def label(case: Case, changes: Mapping[str, Any]) -> str:
    """Changed keys of a case in words, such as "radius 0.5 m, boundary.right viscous".

    A table of the case that is replaced as a whole is named by its type.
    """
    parts = [
        ("" if "." not in key else name, in_words(value) + _unit(case, key, value))
        for name, (key, value) in zip(short_keys(changes), changes.items(), strict=True)
    ]
    return ", ".join(" ".join(part).strip() for part in parts)


def short_keys(changes: Mapping[str, Any]) -> list[str]:
    """The last names of keys, or the full keys where the last names are ambiguous."""
    last = [key.rpartition(".")[2] for key in changes]
    return [
        short if key.count(".") == 1 and last.count(short) == 1 and not isinstance(value, Mapping) else key
        for short, (key, value) in zip(last, changes.items(), strict=True)
    ]


def in_words(value: Any) -> str:
    """A value without quotes; a table as its type followed by its other keys in brackets."""
    if isinstance(value, Mapping):
        kind = [in_words(inner) for key, inner in value.items() if key in DISCRIMINATORS]
        rest = ", ".join(f"{key} {in_words(inner)}" for key, inner in value.items() if key not in DISCRIMINATORS)
        return " ".join([*kind, f"({rest})"] if rest else kind)
    if isinstance(value, list):
        return f"[{', '.join(in_words(inner) for inner in value)}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _unit(case: Case, key: str, value: Any) -> str:
    """The unit of a number at a key of the case, after a blank; empty for pure numbers and unknown keys."""
    if isinstance(value, bool | str | Mapping):
        return ""
    table: Any = case
    *path, last = key.split(".")
    for name in path:
        table = _inner(table, name)
    if not isinstance(table, Table) or last not in type(table).model_fields:
        return ""
    unit = table.described(last).get("unit", "1")
    return "" if unit == "1" else f" {unit}"


def _inner(table: Any, name: str) -> Any:
    """The table with this name in a table, a mapping, or a list of named tables; None if there is none."""
    if isinstance(table, Mapping):
        return table.get(name)
    if isinstance(table, tuple):
        return next((each for each in table if getattr(each, "name", None) == name), None)
    return getattr(table, name, None)

"""Options that several commands share, or that belong together, as fields of one dataclass."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import MISSING, fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import Any, get_type_hints


def with_tables(command: Callable[..., None]) -> Callable[..., None]:
    """A command for typer in which the fields of every dataclass parameter are options.

    The fields are annotated as options of typer. The command gets one object of the class.
    """
    hints = get_type_hints(command, include_extras=True)
    tables: dict[str, type] = {
        name: hint for name, hint in hints.items() if isinstance(hint, type) and is_dataclass(hint)
    }

    @wraps(command)
    def flat(**given: Any) -> None:
        for name, table in tables.items():
            given[name] = table(**{field.name: given.pop(field.name) for field in fields(table)})
        command(**given)

    def parameters() -> Iterator[Parameter]:
        for name, parameter in signature(command).parameters.items():
            if name in tables:
                yield from _options(tables[name])
            else:
                yield parameter.replace(annotation=hints[name])

    flat.__signature__ = Signature(list(parameters()))  # type: ignore[attr-defined]  # what typer reads
    return flat


def _options(table: type) -> Iterator[Parameter]:
    """The fields of a dataclass as parameters by name."""
    types = get_type_hints(table, include_extras=True)
    for field in fields(table):
        default = Parameter.empty if field.default is MISSING else field.default
        yield Parameter(field.name, Parameter.KEYWORD_ONLY, default=default, annotation=types[field.name])

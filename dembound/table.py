"""The base of every table of a case file: frozen, and without unknown keys; and the kinds of values they share."""

import re
import warnings
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.metadata import entry_points
from typing import Annotated, Any, TypeVar, Union

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

T = TypeVar("T")


class Table(BaseModel):
    """One TOML table. Unknown keys are refused, so a mistyped key never goes unnoticed."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    def given(self) -> dict[str, Any]:
        """The keys that have been given, as a TOML file has them; what tells types apart always stands there."""
        keys = [name for name in type(self).model_fields if name in self.model_fields_set | TOLD_APART_BY]
        return {name: as_toml(getattr(self, name)) for name in keys if getattr(self, name) is not None}


TOLD_APART_BY = {"type", "pattern"}
"""Keys whose literal says of which type a table is."""


def as_toml(value: Any) -> Any:
    """Tables, and tuples or mappings of tables, as dictionaries and lists of what a TOML file holds."""
    if isinstance(value, Table):
        return value.given()
    if isinstance(value, Mapping):
        return {name: as_toml(inner) for name, inner in value.items()}
    return [as_toml(inner) for inner in value] if isinstance(value, tuple | list) else value


def quantity(default: Any = ..., *, unit: str, help: str, **limits: Any) -> Any:
    """A physical field: its unit and meaning travel with it into docs and error texts.

    Parameters
    ----------
    default : the value when the key is absent; ``...`` makes the key required.
    unit : SI unit, "1" for a pure number.
    help : one sentence saying what it is.
    limits : pydantic constraints (``gt``, ``ge``, ``lt``, ``le``, ``min_length`` …).
    """
    return Field(default, description=help, json_schema_extra={"unit": unit}, **limits)


def with_registered(group: str, base: type[Any], types: Iterable[type[T]]) -> tuple[type[T], ...]:
    """These types of tables, and those that other installed packages register under the entry point group `group`.

    One that cannot be imported, or is not derived from `base`, is left out with a Python warning.
    """
    found = list(types)
    for entry in _registered().select(group=group):
        try:
            table = entry.load()
        except Exception as error:  # whatever another package may raise
            warnings.warn(f"{group}: {entry.name} ({entry.value}) cannot be imported: {error}", stacklevel=2)
            continue
        if isinstance(table, type) and issubclass(table, base):
            found.append(table)
        else:
            warnings.warn(f"{group}: {entry.name} ({entry.value}) is not derived from {base.__name__}", stacklevel=2)
    return tuple(found)


@cache
def _registered() -> Any:
    """What all installed packages register."""
    return entry_points()


def one_of(key: str, types: Iterable[type[Any]]) -> Any:
    """The annotation of a table that is of one of several types, told apart by the literal at `key`."""
    return Annotated[Union[tuple(types)], Field(discriminator=key)]  # noqa: UP007  # of types known only now


def _serves_as_file_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*", name):
        raise ValueError(f'is "{name}", must be made of the letters A-Z and a-z, digits, "_", "-" and "." (not first)')
    return name


FileName = Annotated[str, AfterValidator(_serves_as_file_name)]
"""A name that may become a file's on every system."""

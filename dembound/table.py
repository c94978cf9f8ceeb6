"""The base of every table of a case file: frozen, and without unknown keys; and the kinds of values they share."""

import ast
import inspect
import math
import re
import sys
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from importlib.metadata import entry_points
from itertools import pairwise
from typing import Annotated, Any, Self, TypeVar, Union, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, field_validator, model_validator
from pydantic.annotated_handlers import GetJsonSchemaHandler

from dembound.errors import CONTROL, UnusableTypeWarning, visible
from dembound.meanings import MEANINGS, OF_UNITS

T = TypeVar("T")

SMALLEST, LARGEST = 1e-30, 1e30
"""Least and largest size of numbers, in SI units: products of a few neither overflow nor vanish."""

LARGEST_WHOLE = 2**63 - 1
"""The largest whole number of a TOML file."""


class Table(BaseModel):
    """One TOML table. Unknown keys are refused, so a mistyped key is always reported."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @field_validator("*", mode="after")
    @classmethod
    def _usable(cls, value: Any) -> Any:
        return usable(value)

    def mistakes(self) -> Iterator[str]:
        """What is wrong with keys that are valid each by itself, a line ``key: what`` each; by default nothing."""
        yield from ()

    @model_validator(mode="after")
    def _has_no_mistakes(self) -> Self:
        if found := dict.fromkeys(self.mistakes()):
            raise ValueError("\n".join(found))
        return self

    def given(self) -> dict[str, Any]:
        """The keys that have been given, in TOML's types; the key that distinguishes tables is always included."""
        fixed = {name for name in DISCRIMINATORS if len(get_args(self._annotation(name))) == 1}  # else it is a choice
        keys = [name for name in type(self).model_fields if name in self.model_fields_set | fixed]
        given = {name: getattr(self, name) for name in keys if getattr(self, name) is not None}
        return {self.key_of(name): as_toml(value) for name, value in given.items()}

    @classmethod
    def _annotation(cls, name: str) -> Any:
        """The annotation of a field; None without this field."""
        return cls.model_fields[name].annotation if name in cls.model_fields else None

    @classmethod
    def described(cls, name: str) -> Mapping[str, Any]:
        """Unit and meaning of a field as given by `quantity`, by these names; empty for other fields."""
        extra = cls.model_fields[name].json_schema_extra
        return extra if isinstance(extra, Mapping) else {}

    @classmethod
    def help_of(cls, name: str) -> str:
        """What a field means: the text below it in its class, or else as given by `quantity`; may be empty."""
        tables = (each for each in cls.__mro__ if issubclass(each, Table))
        texts = (_texts_below_fields(each.__module__).get(each.__name__, {}).get(name) for each in tables)
        return next(filter(None, texts), cls.model_fields[name].description or "")

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """The JSON schema, with the meaning of every key."""
        reference = super().__get_pydantic_json_schema__(core_schema, handler)
        keys = handler.resolve_ref_schema(reference).get("properties", {})
        for name in cls.model_fields:
            if said := cls.help_of(name):
                keys[cls.key_of(name)]["description"] = said
        return reference

    @classmethod
    def key_of(cls, name: str) -> str:
        """The key of a field; another name only where the key is a word of Python, as "from"."""
        return cls.model_fields[name].alias or name


@cache
def _texts_below_fields(module: str) -> dict[str, dict[str, str]]:
    """The texts below the fields of a module's classes, by class and field; none without the source."""
    try:
        classes = ast.parse(inspect.getsource(sys.modules[module])).body
    except (KeyError, OSError, TypeError):  # as of classes that are made in a console
        return {}
    found: dict[str, dict[str, str]] = {}
    for each in (each for each in classes if isinstance(each, ast.ClassDef)):
        for field, below in pairwise(each.body):
            match field, below:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                    found.setdefault(each.name, {})[name] = " ".join(text.split())
    return found


def usable(value: T) -> T:
    """The value of a key, if all its numbers are within the limits and all its texts are one line.

    Raises ValueError, with the limits, if not.
    """
    if isinstance(value, tuple | list):
        for each in value:
            usable(each)
    elif isinstance(value, Mapping):
        for name, each in value.items():
            try:
                usable(name)
                usable(each)
            except ValueError as error:
                raise ValueError(f"{visible(str(name)[:60])} {error}") from None
    elif isinstance(value, str) and CONTROL.search(value):
        raise ValueError(f'is "{visible(value[:60])}", must be one line without control characters')
    elif isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"is {value:g}, must be finite")
    elif isinstance(value, float) and value != 0.0 and not SMALLEST <= abs(value) <= LARGEST:
        raise ValueError(f"is {value:g}, must be 0 or of a size between {SMALLEST:g} and {LARGEST:g}")
    elif isinstance(value, int) and abs(value) > LARGEST_WHOLE:
        raise ValueError(f"has {len(str(abs(value)))} digits, must be at most {LARGEST_WHOLE}")
    return value


DISCRIMINATORS = {"type", "pattern"}
"""Keys whose literal gives the type of a table."""


def as_toml(value: Any) -> Any:
    """Tables, and tuples or mappings of tables, as dictionaries and lists of TOML values."""
    if isinstance(value, Table):
        return value.given()
    if isinstance(value, Mapping):
        return {name: as_toml(inner) for name, inner in value.items()}
    return [as_toml(inner) for inner in value] if isinstance(value, tuple | list) else value


def every_key(value: Any) -> Any:
    """The table with all keys, those that have not been given with their defaults; None for those without a value."""
    if isinstance(value, Table):
        return {value.key_of(name): every_key(getattr(value, name)) for name in type(value).model_fields}
    if isinstance(value, Mapping):
        return {name: every_key(inner) for name, inner in value.items()}
    return [every_key(inner) for inner in value] if isinstance(value, tuple | list) else value


def quantity(
    default: Any = ..., *, help: str | None = None, unit: str = "1", means: str | None = None, **limits: Any
) -> Any:
    """A physical field, with the unit and meaning that docs and error texts print.

    Parameters
    ----------
    default : the value when the key is absent; ``...`` makes the key required.
    help : one sentence with the meaning of the key, unless it stands below the key in its class.
    unit : SI unit, "1" for a pure number.
    means : meaning of a number in `MEANINGS`, with its likely sizes; absent: the only meaning of its unit.
    limits : pydantic constraints (``gt``, ``ge``, ``lt``, ``le``, ``min_length`` …).
    """
    assert means is None or means in MEANINGS, means
    extra: dict[str, Any] = {"unit": unit, "means": means or OF_UNITS.get(unit)}
    return Field(default, description=help, json_schema_extra=extra, **limits)


def with_registered(group: str, base: type[Any], types: Iterable[type[T]]) -> tuple[type[T], ...]:
    """Types of tables, laws or formats, with those that other packages register as entry points of `group`.

    A type that cannot be used is left out, with an `UnusableTypeWarning` that gives the reason.
    """
    found = list(types)
    taken = {name_of(table) for table in found}
    for entry in _registered().select(group=group):
        try:
            table = entry.load()
        except Exception as error:  # whatever another package may raise
            warnings.warn(
                f"{group}: {entry.name} ({entry.value}) cannot be imported: {error}", UnusableTypeWarning, stacklevel=2
            )
            continue
        if table in found:
            continue
        if flaw := _flaw(table, base, taken):
            warnings.warn(f"{group}: {entry.name} ({entry.value}) {flaw}", UnusableTypeWarning, stacklevel=2)
            continue
        taken.add(name_of(table))
        found.append(table)
    return tuple(found)


def name_of(table: type[Any]) -> str | None:
    """Name of a type: the literal at its key in case files, or else its attribute `name`; None without one."""
    fields = getattr(table, "model_fields", {})
    literals = [get_args(fields[key].annotation) for key in DISCRIMINATORS if key in fields]
    name = literals[0][0] if literals and literals[0] else getattr(table, "name", None)
    return name if isinstance(name, str) else None


def _flaw(table: Any, base: type[Any], taken: Collection[str | None]) -> str | None:
    """The reason why a registered type cannot be used; None for a usable one."""
    if not (isinstance(table, type) and issubclass(table, base)):
        return f"is not derived from {base.__name__}"
    if missing := sorted(getattr(table, "__abstractmethods__", ())):
        return f"lacks {', '.join(missing)}"
    if (name := name_of(table)) is None:
        return "has no name: needs a Literal at type or pattern, or for laws and formats of records the attribute name"
    return f'is called "{name}", which is taken' if name in taken else None


@cache
def _registered() -> Any:
    """The entry points of all installed packages."""
    return entry_points()


def one_of(key: str, types: Iterable[type[Any]]) -> Any:
    """The annotation of a table that is of one of several types, distinguished by the literal at `key`."""
    return Annotated[Union[tuple(types)], Field(discriminator=key)]  # noqa: UP007  # types known at run time


Box = tuple[float, float, float, float]
"""A rectangle, with its edges: left, bottom, right and top, m."""

EVERYWHERE: Box = (-math.inf, -math.inf, math.inf, math.inf)
"""The rectangle that contains all places."""


def shifted_place(place: tuple[float, float], by: tuple[float, float]) -> tuple[float, float]:
    """A place (x, y) shifted by (x, y), m."""
    return place[0] + by[0], place[1] + by[1]


def shifted_box(box: Box, by: tuple[float, float]) -> Box:
    """A rectangle shifted by (x, y), m."""
    return *shifted_place((box[0], box[1]), by), *shifted_place((box[2], box[3]), by)


def _serves_as_file_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*", name):
        raise ValueError(f'is "{name}", must be made of the letters A-Z and a-z, digits, "_", "-" and "." (not first)')
    return name


FileName = Annotated[str, AfterValidator(_serves_as_file_name)]
"""A name that is allowed as a file name on every system."""

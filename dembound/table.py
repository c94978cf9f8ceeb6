"""The base of every table of a case file: frozen, and without unknown keys; and the kinds of values they share."""

import re
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field


class Table(BaseModel):
    """One TOML table. Unknown keys are refused, so a mistyped key never goes unnoticed."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


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


def _serves_as_file_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*", name):
        raise ValueError(f'is "{name}", must be made of the letters A-Z and a-z, digits, "_", "-" and "." (not first)')
    return name


FileName = Annotated[str, AfterValidator(_serves_as_file_name)]
"""A name that may become a file's on every system."""

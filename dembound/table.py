"""The base of every table of a case file: frozen, and without unknown keys."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


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

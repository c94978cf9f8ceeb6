"""The ``[motion]`` table."""

from typing import Literal

from pydantic import field_validator

from dembound.table import Table, quantity

Freedom = Literal["x", "y", "rotation"]


class Motion(Table):
    """Components of the motion that are held for all particles."""

    held: tuple[Freedom, ...] = quantity((), unit="1", help="components held at zero for every particle")

    @field_validator("held")
    @classmethod
    def _names_each_once(cls, held: tuple[Freedom, ...]) -> tuple[Freedom, ...]:
        if len(set(held)) < len(held):
            raise ValueError("names a motion twice, must name each once")
        return held

"""The ``[motion]`` table."""

from typing import Literal

from pydantic import field_validator

from dembound.table import Table, quantity

Freedom = Literal["x", "y", "rotation"]


class Motion(Table):
    """The motions that are held for all particles."""

    held: tuple[Freedom, ...] = quantity((), unit="1", help="motions that are held for every particle")

    @field_validator("held")
    @classmethod
    def _names_each_once(cls, held: tuple[Freedom, ...]) -> tuple[Freedom, ...]:
        if len(set(held)) < len(held):
            raise ValueError("names a motion twice, must name each once")
        return held

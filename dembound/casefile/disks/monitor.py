"""The ``[[monitor]]`` tables."""

from typing import Annotated

from pydantic import AfterValidator

from dembound.table import FileName, Table, quantity

FREE_FIELD = ".free_field"
"""Suffix of a monitor's name for the history of its twin in the free-field column."""


def _is_no_twin(name: str) -> str:
    if name.endswith(FREE_FIELD):
        raise ValueError(f'is "{name}", must not end in "{FREE_FIELD}", which is kept for a monitor\'s twin')
    return name


class Monitor(Table):
    """A place at which the motion of the nearest particle, or of the continuum there, is recorded."""

    name: Annotated[FileName, AfterValidator(_is_no_twin)] = quantity(
        ..., unit="1", help="name of the history in the results"
    )
    position: tuple[float, float] = quantity(
        ...,
        unit="m",
        means="place",
        help="where; between equally near particles the lowest is taken, of these the leftmost",
    )

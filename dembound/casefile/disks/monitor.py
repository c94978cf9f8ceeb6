"""The ``[[monitor]]`` tables."""

from typing import Annotated

from pydantic import AfterValidator

from dembound.table import FileName, Table, quantity

FREE_FIELD = ".free_field"
"""What the history of a monitor's twin in the free-field column is called, behind the monitor's name."""


def _is_no_twin(name: str) -> str:
    if name.endswith(FREE_FIELD):
        raise ValueError(f'is "{name}", must not end in "{FREE_FIELD}", which a monitor\'s twin is called')
    return name


class Monitor(Table):
    """A place whose nearest particle's motion is written down at every history step."""

    name: Annotated[FileName, AfterValidator(_is_no_twin)] = quantity(
        ..., unit="1", help="name of the history in the results"
    )
    position: tuple[float, float] = quantity(..., unit="m", help="where, from the scene's lower left corner")

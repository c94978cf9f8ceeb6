"""The ``[[monitor]]`` tables."""

import re

from pydantic import field_validator

from dembound.table import Table, quantity


class Monitor(Table):
    """A place whose nearest particle's motion is written down at every history step."""

    name: str = quantity(..., unit="1", help="name of the history in the results")
    position: tuple[float, float] = quantity(..., unit="m", help="where, from the scene's lower left corner")

    @field_validator("name")
    @classmethod
    def _serves_as_file_name(cls, name: str) -> str:
        if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*", name):
            raise ValueError(
                f'is "{name}", must be made of the letters A-Z and a-z, digits, "_", "-" and "." (not first)'
            )
        return name

"""The ``[sweep]`` table: the members of `dembound sweep`, and how they are run."""

from typing import Literal

from dembound.casefile.vary import Vary
from dembound.table import Table, quantity

Action = Literal["run", "calibrate"]

Method = Literal["impedance", "ratio", "homogenised"]

MOST_PROCESSES = 10_000
"""Largest number of members at once: that of the cores of a large cluster."""


class Sweep(Table):
    """The varied keys of a sweep, what is done with every member, and by how many processes."""

    vary: Vary = quantity({}, unit="1", help='key -> list of values, or a range such as "1:20"')
    together: bool = quantity(
        False, unit="1", help="whether the keys' first values are one member, their second ones the next"
    )
    action: Action = quantity("run", unit="1", help="what is done with every member")
    method: Method = quantity("impedance", unit="1", help="how β is calibrated")
    processes: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="members at once; absent: as many as there are cores",
        ge=1,
        le=MOST_PROCESSES,
    )

"""The ``[sweep]`` table: the members of `dembound sweep`, and how they are run."""

from typing import Literal

from dembound.casefile.vary import Vary
from dembound.table import Table, quantity

Action = Literal["run", "calibrate"]

Method = Literal["impedance", "ratio", "homogenised"]

MOST_PROCESSES = 10_000
"""Largest number of members at once: the cores of a large cluster."""


class Sweep(Table):
    """Members of `dembound sweep`, whose options override it; runs do not depend on it."""

    vary: Vary = quantity(
        {}, unit="1", help='key -> list of values, or range such as "1:20" or, with a step, "0:100:25"'
    )
    together: bool = quantity(
        False,
        unit="1",
        help="whether the first values of all keys are one member, the second ones the next; else all combinations",
    )
    action: Action = quantity("run", unit="1", help="action for every member")
    method: Method = quantity("impedance", unit="1", help="how β is calibrated")
    processes: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="members at once; absent: as many as there are cores",
        ge=1,
        le=MOST_PROCESSES,
    )

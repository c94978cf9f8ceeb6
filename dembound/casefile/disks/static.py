"""The ``[static]`` table and the tables of its sides."""

from collections.abc import Mapping

from dembound.boundaries import Boundary
from dembound.casefile.types import StaticSide
from dembound.table import Table, quantity

RATIO = 1e-5
"""Force ratio at rest under the elastic law, where what is left acts as constant forces and changes no motion."""

RATIO_SLIDING = 1e-7
"""Force ratio at rest under a history-dependent law.

What is left decides there which contacts at the limit of friction slide as a wave begins, see
`dembound.accuracy.of_disks.rest`."""

MOST_STEPS = 100_000_000
"""Largest number of steps of the stage: a hundred disks take minutes for these, and thousands of steps are enough."""


class Static(Table):
    """The damped stage before the run, which brings the body to rest under steady loads and a given stress.

    Its supports replace the boundaries of the sides during the stage; their reactions then act as constant forces.
    It needs a `stress`, a steady load or `material.locked_in`; the body must be held along every axis on which a steady
    load acts. Under `k0`, and under a stress beside periodic, free-field and outside sides, contacts begin with the
    forces of that stress; otherwise forces on the sides make it.
    """

    stress: tuple[float, float, float] | None = quantity(
        None,
        unit="Pa",
        means="stress to reach",
        help="stress [sxx, syy, sxy] to reach, tension positive; absent: that of the loads",
    )
    k0: float | None = quantity(
        None,
        unit="1",
        means="ratio of stresses",
        help="stress along x over that along y due to weight, a load with an acceleration; absent: what settling makes",
        ge=0.0,
        le=5.0,
    )
    ratio: float | None = quantity(
        None,
        unit="1",
        means="rest",
        help="mean unbalanced force over mean contact force at which the stage is over; "
        "absent: 1e-5, and 1e-7 once contacts slide or open or bonds break",
        gt=0.0,
        lt=1.0,
    )
    damp: float = quantity(0.7, unit="1", means="share", help="local damping coefficient of the stage", gt=0.0, lt=1.0)
    max_steps: int = quantity(
        200_000, unit="1", means="count", help="steps after which the stage has failed", ge=1, le=MOST_STEPS
    )
    from_: str | None = quantity(
        None,
        unit="1",
        help="folder of the results of a case that has settled the same body, from the current folder; absent: none",
        alias="from",
        min_length=1,
    )
    boundary: Mapping[str, StaticSide] = quantity(
        {}, unit="1", help="a table for each side during the stage; an absent side is free"
    )

    def enough(self, *, slides: bool) -> float:
        """The force ratio at which the stage is over; slides : whether under a history-dependent law."""
        return self.ratio or (RATIO_SLIDING if slides else RATIO)


def begins_stressed(static: Static, boundaries: Mapping[str, Boundary | None]) -> bool:
    """Whether contacts begin with the forces of a stress at rest: with K0, or beside sides that could not apply it."""
    tables = [table for table in boundaries.values() if table]
    beside = any(table.is_periodic or table.needs_column or table.is_outside for table in tables)
    return static.k0 is not None or (static.stress is not None and beside)

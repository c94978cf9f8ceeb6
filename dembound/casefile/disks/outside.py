"""The ``[outside]`` table."""

from dembound.table import Table, quantity

MOST_ELEMENTS = 1000
"""Largest number of elements of a margin or of layers: six that absorb are enough, and 100 beside a load that stays."""

CONTINUUM = ".continuum"
"""Ending of the names of sides of the continuum."""


class OutsideTable(Table):
    """The continuum beyond sides of type "outside": spectral elements, the outer ones of which absorb.

    Settings that are absent are chosen from the waves and loads of the case and the accuracy.
    """

    order: int = quantity(
        4, unit="1", means="count", help="order of the elements, nodes along a side less one", ge=3, le=6
    )
    accuracy: float = quantity(
        1e-3,
        unit="1",
        means="share",
        help="error of velocities that the settings left out are chosen for",
        gt=0.0,
        lt=1.0,
    )
    element: float | None = quantity(
        None, unit="m", means="length", help="largest side of an element; absent: by the accuracy", gt=0.0
    )
    margin: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="elements between the particles and those that absorb; absent: by the loads",
        ge=1,
        le=MOST_ELEMENTS,
    )
    layers: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="elements that absorb, one behind the other; absent: by the accuracy",
        ge=2,
        le=MOST_ELEMENTS,
    )
    reflection: float | None = quantity(
        None,
        unit="1",
        means="share",
        help="amplitude that a P wave keeps on its way through the layers and back; absent: accuracy/10",
        gt=0.0,
        lt=1.0,
    )
    shift: float = quantity(
        0.3, unit="1", means="setting", help="α of the layers, over c_p/2L, with L the larger side within them", gt=0.0
    )
    delay: float = quantity(
        0.1, unit="1", means="setting", help="τ of the layers, in time steps; 0 grows in long runs", ge=0.0
    )
    damping: float = quantity(0.1, unit="1", means="setting", help="dashpots of the ties, over ρ c_p D", ge=0.0)

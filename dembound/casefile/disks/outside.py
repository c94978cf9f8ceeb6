"""The ``[outside]`` table."""

from dembound.table import Table, quantity

MOST_ELEMENTS = 1000
"""Largest number of elements of a margin or of layers: six absorbing ones are enough, and a margin of 100 beside a
lasting load.
"""

CONTINUUM = ".continuum"
"""Suffix of the names of sides of the continuum."""


class OutsideTable(Table):
    """The continuum beyond sides of type "outside", of spectral elements; keys left out follow from `accuracy`.

    Its outer elements absorb.
    """

    order: int = quantity(
        4, unit="1", means="count", help="order of the elements, nodes along a side less one", ge=3, le=6
    )
    accuracy: float = quantity(
        1e-3,
        unit="1",
        means="share",
        help="error of velocities for which the keys left out are chosen",
        gt=0.0,
        lt=1.0,
    )
    element: float | None = quantity(
        None, unit="m", means="length", help="largest side of an element; absent: from waves and accuracy", gt=0.0
    )
    margin: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="elements between the particles and those that absorb; absent: 1, more under lasting loads",
        ge=1,
        le=MOST_ELEMENTS,
    )
    layers: int | None = quantity(
        None,
        unit="1",
        means="count",
        help="elements that absorb, one behind the other, five wider ones more beside layers; absent: from accuracy",
        ge=2,
        le=MOST_ELEMENTS,
    )
    reflection: float | None = quantity(
        None,
        unit="1",
        means="share",
        help="R0, amplitude that a P wave keeps on its way through the layers and back; absent: accuracy/10",
        gt=0.0,
        lt=1.0,
    )
    shift: float = quantity(
        0.3,
        unit="1",
        means="setting",
        help="α of the layers over c_p/2L, L being the larger side of what lies within them",
        gt=0.0,
    )
    delay: float = quantity(
        0.1, unit="1", means="setting", help="τ of the layers, in time steps; 0 grows in long runs", ge=0.0
    )
    damping: float = quantity(
        0.1, unit="1", means="setting", help="dashpots of the ties between disks and continuum, over ρ c_p D", ge=0.0
    )

"""The ``[outside]`` table."""

from dembound.table import Table, quantity


class OutsideTable(Table):
    """The continuum beyond sides of type "outside": spectral elements, the outer ones of which absorb.

    An element size of zero is chosen from the waves of the case.
    """

    order: int = quantity(4, unit="1", help="order of the elements, nodes along a side less one", ge=3, le=6)
    accuracy: float = quantity(
        1e-3, unit="1", help="error of waves in the continuum that the automatic element size allows", gt=0.0, lt=1.0
    )
    element: float = quantity(0.0, unit="m", help="largest side of an element; 0: by the accuracy", ge=0.0)
    margin: int = quantity(1, unit="1", help="elements between the particles and those that absorb", ge=1)
    layers: int = quantity(3, unit="1", help="elements that absorb, one behind the other", ge=2)
    reflection: float = quantity(
        1e-4, unit="1", help="amplitude that a P wave keeps on its way through the layers and back", gt=0.0, lt=1.0
    )
    damping: float = quantity(0.3, unit="1", help="dashpots of the ties, over ρ c_p D", ge=0.0)

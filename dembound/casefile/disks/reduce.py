"""The ``[reduce]`` table."""

from dembound.table import Table, quantity


class Reduce(Table):
    """Parts of a scene that are not stepped, as their motion follows from that of other parts."""

    rows: bool = quantity(True, unit="1", help="whether rows of disks that move identically are stepped as one")
    settled: bool = quantity(
        False, unit="1", help="whether the elastic law serves again after a static stage if nothing is open or slides"
    )

"""The ``[[monitor]]`` tables."""

from dembound.case.names import FileName
from dembound.table import Table, quantity


class Monitor(Table):
    """A place whose nearest particle's motion is written down at every history step."""

    name: FileName = quantity(..., unit="1", help="name of the history in the results")
    position: tuple[float, float] = quantity(..., unit="m", help="where, from the scene's lower left corner")

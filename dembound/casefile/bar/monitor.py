"""The ``[[monitor]]`` tables of a bar."""

from dembound.table import FileName, Table, quantity


class BarMonitor(Table):
    """A gauge: the motion and the stress of the nearest node are recorded at every history step."""

    name: FileName = quantity(..., unit="1", help="name of the history in the results")
    position: float = quantity(..., unit="m", means="place", help="where, from the bar's left end", ge=0.0)

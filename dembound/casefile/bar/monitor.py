"""The ``[[monitor]]`` tables of a bar."""

from dembound.table import FileName, Table, quantity


class BarMonitor(Table):
    """A gauge: records motion and stress of the nearest node, half-way between two nodes of the left one."""

    name: FileName = quantity(..., unit="1", help="name of the history in the results")
    position: float = quantity(..., unit="m", means="place", help="where, from the bar's left end", ge=0.0)

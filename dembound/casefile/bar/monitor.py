"""The ``[[monitor]]`` tables of a bar."""

from dembound.table import FileName, Table, quantity


class BarMonitor(Table):
    """A gauge: motion and stress of the nearest node, half-way between two of the left one, are recorded."""

    name: FileName = quantity(..., unit="1", help="name of the history in the results")
    position: float = quantity(..., unit="m", means="place", help="where, from the bar's left end", ge=0.0)

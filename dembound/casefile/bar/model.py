"""A case of a bar: all tables of one file."""

from dataclasses import dataclass

from dembound.casefile.bar.bar import Bar
from dembound.casefile.bar.load import BarLoad
from dembound.casefile.bar.monitor import BarMonitor
from dembound.casefile.bar.run import BarRun
from dembound.casefile.model import Case
from dembound.methods import Method


@dataclass(frozen=True, kw_only=True, repr=False)
class BarCase(Case):
    """A case of a bar.

    Attributes
    ----------
    bar, method : the tables of these names.
    """

    bar: Bar
    method: Method
    load: tuple[BarLoad, ...] = ()
    monitor: tuple[BarMonitor, ...] = ()
    run: BarRun

    @property
    def loaded(self) -> str:
        """The end that loads act on or a wave drives: "left", "right", "both" or "none"."""
        ends = self.driving.keys() | {load.side for load in self.load}
        return "both" if len(ends) > 1 else next(iter(ends), "none")

"""The case itself: all tables of one file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dembound.boundaries import BoundaryTable
from dembound.boundaries.driven import Driven
from dembound.case.bar import Bar
from dembound.case.bar_load import BarLoad
from dembound.case.bar_monitor import BarMonitor
from dembound.case.bar_run import BarRun
from dembound.case.load import Load
from dembound.case.material import Material
from dembound.case.monitor import Monitor
from dembound.case.motion import Motion
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.case.static import Static
from dembound.holes import HoleTable
from dembound.methods import MethodTable
from dembound.packings import PackingTable
from dembound.waves import WaveTable


@dataclass(frozen=True, kw_only=True)
class Case:
    """One validated case file, of disks or of a bar. Build it with `load` or `loads`, which check what it cannot.

    Attributes
    ----------
    title : one line for pictures and reports; may be empty.
    boundary : side -> table, in the order left, right, bottom, top; an absent side is free.
    wave : name -> table.
    load, monitor : in the order of the file.
    run, output : the tables of these names.
    name : the file's name without folder and ending.
    text : the TOML text the case was read from.
    folder : where relative paths in the case start.

    Two cases are equal when their tables are; name, text and folder do not count.
    """

    title: str
    boundary: Mapping[str, BoundaryTable]
    wave: Mapping[str, WaveTable]
    load: tuple[Any, ...]
    monitor: tuple[Any, ...]
    run: Run
    output: Output
    name: str = field(compare=False)
    text: str = field(compare=False, repr=False)
    folder: Path = field(compare=False)


@dataclass(frozen=True, kw_only=True)
class DiskCase(Case):
    """A case of bonded disks.

    Attributes
    ----------
    packing, material, motion : the tables of these names.
    static : the table of this name; None: no static stage.
    hole : in the order of the file.
    """

    packing: PackingTable
    material: Material
    motion: Motion
    static: Static | None
    hole: tuple[HoleTable, ...]
    load: tuple[Load, ...]
    monitor: tuple[Monitor, ...]


@dataclass(frozen=True, kw_only=True)
class BarCase(Case):
    """A case of a bar.

    Attributes
    ----------
    bar, method : the tables of these names.
    """

    bar: Bar
    method: MethodTable
    load: tuple[BarLoad, ...]
    monitor: tuple[BarMonitor, ...]
    run: BarRun

    @property
    def loaded(self) -> str:
        """The end that loads act on or a wave drives: "left", "right", "both" or "none"."""
        driven = {side for side, table in self.boundary.items() if isinstance(table, Driven)}
        ends = driven | {load.side for load in self.load}
        return "both" if len(ends) > 1 else next(iter(ends), "none")

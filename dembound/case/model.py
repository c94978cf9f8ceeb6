"""The case itself: all tables of one file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from dembound.boundaries import BoundaryTable
from dembound.case.load import Load
from dembound.case.material import Material
from dembound.case.monitor import Monitor
from dembound.case.motion import Motion
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.case.static import Static
from dembound.holes import HoleTable
from dembound.packings import PackingTable
from dembound.waves import WaveTable


@dataclass(frozen=True, kw_only=True)
class Case:
    """One validated case file. Build it with `load` or `loads`, which check what a constructor cannot.

    Attributes
    ----------
    title : one line for pictures and reports; may be empty.
    packing, material, motion, run, output : the tables of these names.
    boundary : side -> table, in the order left, right, bottom, top; an absent side is free.
    static : the table of this name; None: no static stage.
    wave : name -> table.
    hole, load, monitor : in the order of the file.
    name : the file's name without folder and ending.
    text : the TOML text the case was read from.
    folder : where relative paths in the case start.

    Two cases are equal when their tables are; name, text and folder do not count.
    """

    title: str
    packing: PackingTable
    material: Material
    motion: Motion
    boundary: Mapping[str, BoundaryTable]
    static: Static | None
    wave: Mapping[str, WaveTable]
    hole: tuple[HoleTable, ...]
    load: tuple[Load, ...]
    monitor: tuple[Monitor, ...]
    run: Run
    output: Output
    name: str = field(compare=False)
    text: str = field(compare=False, repr=False)
    folder: Path = field(compare=False)

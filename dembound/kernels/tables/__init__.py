"""Bundles of arrays, the arguments of kernels."""

from dembound.kernels.tables.bar_layers import BarLayers
from dembound.kernels.tables.contacts import Cells, Contacts, LaneRows, Limits, NeighbourTable, PairRows
from dembound.kernels.tables.damping import Crossing, DampedGrid, DampedLinks, Drag, Memories, NoDrag, TieMemories
from dembound.kernels.tables.grid import ALONG, Absorber, Blocks, Elements, Grid, Shape
from dembound.kernels.tables.laws import BarBonds, BarContacts, Bonded, Dashed, LaneBonded, Links, WatchedLinks
from dembound.kernels.tables.motion import Body, Followers, Log, Supports
from dembound.kernels.tables.sides import NO_SIDES, Sides
from dembound.kernels.tables.softening import Softening
from dembound.kernels.tables.ties import Bearings, Repeats, Seam, SeamEnds, WallTies

__all__ = [
    "ALONG",
    "NO_SIDES",
    "Absorber",
    "BarBonds",
    "BarContacts",
    "BarLayers",
    "Bearings",
    "Blocks",
    "Body",
    "Bonded",
    "Cells",
    "Contacts",
    "Crossing",
    "DampedGrid",
    "DampedLinks",
    "Dashed",
    "Drag",
    "Elements",
    "Followers",
    "Grid",
    "LaneBonded",
    "LaneRows",
    "Limits",
    "Links",
    "Log",
    "Memories",
    "NeighbourTable",
    "NoDrag",
    "PairRows",
    "Repeats",
    "Seam",
    "SeamEnds",
    "Shape",
    "Sides",
    "Softening",
    "Supports",
    "TieMemories",
    "WallTies",
    "WatchedLinks",
]

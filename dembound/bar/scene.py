"""Builds the scene of a case with a ``[bar]``: places the nodes, supports and loads them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dembound.bar.body import BarBody
from dembound.bar.layers import ENDS, EndLayer, LayerTie, layers_of
from dembound.bar.part import BarPart
from dembound.bar.ram import must_fit_here
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Supports
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import Bar
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Range, Rod
from dembound.motion.part import System

HELD = (1, 2)
"""A bar moves only along x."""


@dataclass(frozen=True)
class BarScene(BarBody):
    """The arrays of a case of a bar."""

    def system(self, time_step: float, first: Bonds | None = None) -> System:
        """The bar and its layers at rest, to be stepped by time_step (s).

        first : bonds to begin with; by default the first bonds of the method.
        """
        ties = [LayerTie(list(self.layers.values()), self.count, time_step)] if self.layers else []
        part = BarPart(self, time_step, first, ties[0].through if ties else None)
        return System([part], ties, self.steady_load)


def build_bar(case: BarCase) -> BarScene:
    """Place a bar's nodes and support them; raises CaseError when a run needs more RAM than is free."""
    must_fit_here(case)
    bar = case.bar
    rod = _rod(bar).continued(*(case.method.horizon_beyond if case.side(side).layer else 0 for side in ENDS))
    positions = np.stack([rod.positions, np.zeros(rod.count)], axis=1)
    edges = {side: _edge(case, side) for side in ("left", "right")}
    monitors = {monitor.name: rod.nearest(monitor.position) for monitor in case.monitor}
    layers = layers_of(case, rod)
    return BarScene(case, rod, positions, edges, _supports(case, rod, edges, layers), monitors, layers)


def _rod(bar: Bar) -> Rod:
    """The nodes of a bar; those at a bonded interface are shared, at a contact each range has its own."""
    ranges: list[Range] = []
    gaps = [given.gap for given in bar.range] or [0.0]
    for part, start, touches, gap in zip(bar.parts, bar.starts, bar.contacts, gaps, strict=True):
        first = ranges[-1].last + touches if ranges else 0
        material = part.modulus, part.density, part.breaking_stretch, part.drag_rate
        size = start, part.length / part.cells, part.area
        ranges.append(Range(first, first + part.cells, *size, *material, gap, fracture=part.fracture))
    return Rod(tuple(ranges))


def end_supports(case: BarCase, side: str) -> Supports:
    """Support table of the boundary of one end, without loads and attenuation; empty for a free end."""
    builder = SupportBuilder(held=HELD)
    case.side(side).support(_edge(case, side), bar_medium(case, side), case.wave, builder)
    return builder.table()


def _edge(case: BarCase, side: str) -> Edge:
    """An end, which consists of one node."""
    bar, area = case.bar, case.bar.end(side).area
    node, place = (0, 0.0) if side == "left" else (bar.nodes - 1, bar.length)
    return Edge(side, np.array([node]), np.array([[place, 0.0]]), np.array([area]), area)


def bar_medium(case: BarCase, side: str) -> BoundaryMedium:
    """The medium that an absorbing end represents: the same bar, continued."""
    none, end = np.zeros(1), case.bar.end(side)
    return BoundaryMedium(end.density, end.speed, 0.0, lambda diameters: (none, none))


def _supports(case: BarCase, rod: Rod, edges: Mapping[str, Edge], layers: Mapping[str, EndLayer]) -> Supports:
    """The support table: both ends, all loads, and the attenuation of nodes that are supported or tied to layers."""
    builder = SupportBuilder(held=HELD)
    for side, table in case.boundary.items():
        builder.side = side
        table.support(edges[side], bar_medium(case, side), case.wave, builder)
    builder.side = ""
    for load in case.load:
        nodes = np.arange(load.nodes) if load.side == "left" else np.arange(rod.count - load.nodes, rod.count)
        share = rod.volumes[nodes] / rod.volumes[nodes].sum()
        inwards = 1.0 if load.side == "left" else -1.0
        force = inwards * load.pressure * rod.end(load.side).section * share
        builder.add(nodes, 0, drive=force, signal=case.wave[load.wave].velocity)
    supported = np.unique(np.concatenate([builder.table().node, *(layer.inner for layer in layers.values())]))
    drag = rod.summed(lambda part: part.drag_rate * part.density * part.volumes)
    builder.add(supported, 0, damping=drag[supported])
    return builder.table()

"""Builds the scene of a case with a ``[bar]``: nodes, supports and loads, and the wave that enters."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dembound.bar.body import BarBody
from dembound.bar.layers import ENDS, EndLayer, LayerTie, layers_of
from dembound.bar.memory import must_fit_here
from dembound.bar.part import BarPart
from dembound.boundaries.edge import BoundaryMedium, Edge
from dembound.boundaries.support import SupportBuilder, Supports
from dembound.casefile.bar.bar import Bar
from dembound.casefile.bar.model import BarCase
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


MOMENTS = 500
"""Number of times at which the wave is computed."""


def entering_pressure(case: BarCase, side: str, time: np.ndarray, *, loads: bool = True) -> np.ndarray:
    """Pressure (Pa), of the shape of times (s), of the wave that enters at an end, with or without its loads.

    The forces F at the end are balanced by ρcA·v of the bar and C·v of the dashpots, or ρcA·v of a layer beyond it, so
    that the pressure ρcv is F·ρc/(ρcA + C). An end whose motion is prescribed has the prescribed v. The forces of
    springs are neglected.
    """
    bar = case.bar.end(side)
    inwards = 1.0 if side == "left" else -1.0
    supports = end_supports(case, side)
    driven = supports.sample(np.ravel(time), 0.0).sum(axis=1).reshape(np.shape(time))
    if supports.prescribed.any():
        return inwards * bar.density * bar.speed * driven
    force = inwards * driven
    for load in case.load:
        if loads and load.side == side:
            force = force + load.pressure * bar.area * case.wave[load.wave].velocity(time)
    impedance = bar.density * bar.speed
    beyond = impedance * bar.area if case.side(side).layer else supports.damping.sum()
    return impedance / (impedance * bar.area + beyond) * force


def moments(case: BarCase, side: str) -> np.ndarray:
    """Times (s), ascending, at which to compute the wave that enters at an end, from its beginning to its end.

    Begin and end are searched within the duration of the run or of the waves, whichever is longer. The times of the
    waves' crests are included.
    """
    waves = [case.wave[load.wave] for load in case.load if load.side == side]
    waves += [case.wave[name] for name in case.side(side).waves.values()]
    over = [wave.duration() if np.isfinite(wave.duration()) else wave.peak_time() for wave in waves]
    ends = max(over, default=0.0), case.run.duration
    looked = np.unique([np.linspace(0.0, end, MOMENTS) for end in ends])
    busy = np.flatnonzero(entering_pressure(case, side, looked))
    if len(busy) == 0:
        return looked[:1]
    begin, end = looked[max(busy[0] - 1, 0)], looked[min(busy[-1] + 1, len(looked) - 1)]
    crests = [wave.peak_time() for wave in waves if begin < wave.peak_time() < end]
    return np.union1d(np.linspace(begin, end, MOMENTS), crests)

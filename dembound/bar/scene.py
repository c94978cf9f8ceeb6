"""The part of a bar with the bonds of its method, and the scene of a case: supports, loads, the wave that enters."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dembound.bar.body import ROUNDING, BarBody, must_fit_here
from dembound.bar.layers import ENDS, EndLayer, LayerTie, layers_of
from dembound.boundaries.edge import BoundaryMedium, Edge
from dembound.boundaries.support import SupportBuilder, Supports
from dembound.casefile.bar.bar import Bar
from dembound.casefile.bar.model import BarCase
from dembound.errors import RunError
from dembound.kernels import bar
from dembound.kernels.common import TRIGGERED
from dembound.kernels.tables import BarBonds
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Range, Rod
from dembound.motion.part import Cracks, Part, System
from dembound.motion.state import Arrays, State

SWING = 1e-6
"""Share by which the motion of a node with a prescribed velocity may exceed the bound of a stable step."""


class BarPart(Part):
    """A bar under its method.

    Parameters
    ----------
    scene : the bar; time_step : Δt in s.
    first : bonds to begin with; by default the first bonds of the method.
    through : of the scene's layers, see kernels.tables.BarLayers.

    Attributes
    ----------
    bonds : springs and bonds as they are now.
    bond_updates : forces of springs and bonds computed so far.
    """

    name = "bar"
    is_summarised = True
    evolving = ("law_name", "bond_updates", "_unstable", "_reported")

    def __init__(
        self, scene: BarBody, time_step: float, first: Bonds | None = None, through: np.ndarray | None = None
    ) -> None:
        self.scene = scene
        self.nodes = slice(0, scene.count)
        self.law_name = scene.case.method.name
        self.bonds = scene.case.method.begin(scene.rod) if first is None else first
        self.bond_updates = 0
        self._step, self._through = time_step, through
        self._supported = np.unique(scene.supports.node)
        self._arrays = self._lay()
        self._unstable = not self._is_stable()
        self._reported = 0

    def _lay(self) -> BarBonds:
        """The bonds for the kernels."""
        return self.bonds.arrays(self._supported, self._step, self._through)

    def law(self) -> BarBonds:
        """The bonds as they are now."""
        return self._arrays

    def react(self, why: int, steps: int, state: State) -> None:
        """Let the method change the bonds at a spring that has reached its limit.

        Raises RunError if the time step is unstable with the new bonds.
        """
        self.bond_updates += steps * self.bonds.alive
        self._refuse_breaks_at_layers()
        if why == TRIGGERED:
            u = state.u[0]
            self._change_bonds(u, u - self._step * state.v[0], state)

    def _refuse_breaks_at_layers(self) -> None:
        """Raise RunError if a bond broke at a node whose bonds reach into a layer, as these never break."""
        if not (self.scene.layers and np.isfinite(self.scene.rod.elongation).any()):
            return
        step, pair = self.bonds.begun()
        for side, layer in self.scene.layers.items():
            for k in np.flatnonzero(np.isin(pair, layer.inner).any(axis=1))[:1]:
                raise RunError(
                    f"the bar broke at t = {step[k] * self._step:g} s within {len(layer.inner) * layer.spacing:g} m of "
                    f"its {side} end, where bonds reach into the matched layer, which never break; make the bar longer"
                )

    def _change_bonds(self, u: np.ndarray, before: np.ndarray, state: State) -> None:
        """Let the method change the bonds, and add the energy difference to the ledger.

        u : (n,) m, displacements now; before : one step earlier.
        """
        stored, alive = self._between(u, before), self.bonds.alive
        self.law_name = self.scene.case.method.on_trigger(self.bonds, u)
        self._arrays = self._lay()
        state.work[:, 4] += self._between(u, before) - stored
        if self.bonds.alive > alive and not self._is_stable():
            limit = self.scene.stable_step(self.bonds)
            raise RunError(
                f"the method's bonds at t = {state.step * self._step:g} s allow a time step of {limit:.6g} s only; "
                "take a smaller run.time_step or run.courant"
            )

    def _is_stable(self) -> bool:
        """Whether the time step is stable with the present bonds; it remains so while bonds only break."""
        return self.scene.is_stable(self.bonds, self._step * (1.0 - ROUNDING))

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) in local springs and in peridynamic bonds."""
        return bar.stored(u[0], self._arrays)

    def _between(self, u: np.ndarray, before: np.ndarray) -> float:
        """Strain energy (J) half a step earlier, ½ uᵀK u⁻, which central differences conserve."""
        return 0.25 * (sum(bar.stored(u + before, self._arrays)) - sum(bar.stored(u - before, self._arrays)))

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node at which a run is unstable and gains energy; None for a stable run. velocity (3, n) m/s.

        A stable step has ½ vᵀMv ≥ ½ (½Δt v)ᵀK(½Δt v) for any v, so velocities that violate this belong to an
        instability. If bonds break first, the remaining bar may be so soft that the condition holds; then the step is
        judged by the bonds before they broke.
        """
        v = velocity[0] / max(1.0, np.abs(velocity[0]).max())  # scaled so that squares do not overflow
        kinetic = 0.5 * float(np.sum(self.scene.mass * v**2))
        swing = sum(bar.stored(0.5 * self._step * v, self._arrays))
        broken = self._unstable and len(self.bonds.breaks(0)[0]) > 0
        return int(np.argmax(np.abs(v))) if broken or swing > kinetic * (1.0 + SWING) else None

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps: number of steps done."""
        step, pair = self.bonds.breaks(self._reported)
        self._reported = steps
        middle = self.scene.positions[pair].mean(axis=1)
        return Cracks(step, pair, middle, np.zeros(len(step), dtype=np.bool_))

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress, tension positive, and local damage of every node."""
        return {"stress": (self.stress(displacement), "Pa"), "damage": (self.bonds.damage(), "1")}

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (n,) Pa along the bar at displacements (3, n), tension positive."""
        stress = np.empty(self.scene.count)
        bar.stresses(displacement[0], self._arrays, stress)
        return stress

    def saved_arrays(self) -> Arrays:
        """Springs, bonds and zones, the method in use, and the counters."""
        return {**super().saved_arrays(), **self.bonds.saved_arrays()}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self.bonds.restore(saved)
        self._arrays = self._lay()


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

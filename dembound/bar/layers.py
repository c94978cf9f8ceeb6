"""Matched layers beyond the ends of a bar: their nodes and bonds, and the tie by which they absorb.

Let v and f be the velocities of all nodes and the forces of all bonds, bar included, M and K their masses and
stiffnesses, G the elongations of bonds by node, h = Δt/2, and a, b ≥ 0 the rates of nodes and bonds times h, zero in
the bar. With the mean velocities v̄ of two half steps the scheme of kernels/bar_layer.py is

    M (v̄' − v̄) + aM (v̄' + v̄) + hGᵀ(f' + f) = 0
    (K⁻¹ − h²GM⁻¹Gᵀ)(f' − f) + bK⁻¹(f' + f) = hG [(v̄' + v̄) + a(v̄' − v̄)]

from one step to the next ('). Multiplied by ½(v̄' + v̄) and ½(f' + f) the sum is, with y = hGᵀ(f' + f), w = v̄' + v̄,

    E' − E = −½ Σ (b/k)(f' + f)² − ½ Σ a (m w² + a w y + y²/m),    E = ½ v̄ᵀMv̄ + ½ fᵀ(K⁻¹ − h²GM⁻¹Gᵀ)f .

Both sums are not negative if a ≤ 2, and E is positive below the limit of central differences without decay, with K and
M of the longer bar. So noise never grows, and that limit holds as long as dΔt ≤ 4 (`MOST_DECAY`). With attenuation γ
the springs mdγ to the ground are bonds without decay; taken at the mean of three steps they add h²dγm to the masses, so
that no frequency exceeds that of the bar without them.

The layer ends free. Its nodes are not those of the scene: its velocities and bond forces belong to the tie, and what
its bonds do to the bar is work of the end.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.boundary import Layer
from dembound.casefile.bar import BarCase
from dembound.kernels import bar_layer  # noqa: F401  # it registers its tie
from dembound.kernels.tables import BarLayers
from dembound.methods.rod import Rod
from dembound.motion.part import Tie
from dembound.motion.state import Arrays

ENDS = ("left", "right")
"""Names of the ends of a bar."""

MOST_DECAY = 4.0
"""Largest rate of a node times the time step with which the energy cannot grow."""


@dataclass(frozen=True)
class EndLayer:
    """The layer beyond one end of a bar: N nodes, numbered outwards after the b nodes of the bar bonded to them.

    Attributes
    ----------
    side : the end.
    layer : its profile.
    inner : (b,) numbers of the bar's nodes, the end node last.
    stiffness : (b,) N/m of the bonds by length.
    mass : kg of a node.
    spacing, speed : m and m/s, of the bar.
    drag_rate : 1/s, of the dashpots that attenuate, 2αc.
    """

    side: str
    layer: Layer
    inner: np.ndarray
    stiffness: np.ndarray
    mass: float
    spacing: float
    speed: float
    drag_rate: float

    @property
    def length(self) -> float:
        """Length of the layer, m."""
        return self.layer.nodes * self.spacing

    @property
    def count(self) -> int:
        """Number of its nodes, with those of the bar that are bonded to them."""
        return len(self.inner) + self.layer.nodes

    @property
    def step_limit(self) -> float:
        """The largest time step (s) at which the proof of its energy holds; infinite where nothing decays."""
        largest = float(self.node_rates[-1]) + self.drag_rate
        return MOST_DECAY / largest if largest > 0.0 else math.inf

    @cached_property
    def node_rates(self) -> np.ndarray:
        """(b + N,) 1/s."""
        return self.layer.rates(self._depth, self.spacing, self.speed)

    @cached_property
    def bond_rates(self) -> np.ndarray:
        """(b, b + N) 1/s, at the middle of the bonds: row p − 1 has those between i and i + p."""
        half = 0.5 * np.arange(1, len(self.inner) + 1)[:, None]
        return self.layer.rates(self._depth + half, self.spacing, self.speed)

    @cached_property
    def bonds(self) -> np.ndarray:
        """Stiffness (b, b + N) N/m of the bonds that reach into the layer, 0 where there is none; rows as in bands."""
        length = np.arange(1, len(self.inner) + 1)[:, None]
        outer = np.arange(self.count) + length
        return np.where((len(self.inner) <= outer) & (outer < self.count), self.stiffness[:, None], 0.0)

    def endless(self, duration: float) -> EndLayer:
        """The layer without decay, with so many nodes that nothing comes back within a time (s)."""
        count = 100 + math.ceil(duration * self.speed / self.spacing)
        return replace(self, layer=Layer(count, power=1.0, reflection=1.0))

    @property
    def ground(self) -> np.ndarray:
        """(b + N,) N/m of springs to the ground, which match the attenuation."""
        return self.mass * self.drag_rate * self.node_rates

    @property
    def _depth(self) -> np.ndarray:
        """(b + N,) distances of the nodes beyond the end, in spacings."""
        return np.arange(self.count) - (len(self.inner) - 1.0)

    def bands(self) -> np.ndarray:
        """The stiffness matrix (N/m) of its bonds as lower bands (b + 1, b + N), nodes numbered outwards.

        The springs to the ground are left out: taken at the mean of three steps, they do not lower the step limit.
        """
        bands = np.zeros((len(self.inner) + 1, self.count))
        for p, row in enumerate(self.bonds, start=1):
            bands[0] += row
            bands[0, p:] += row[:-p]
            bands[p] -= row
        return bands


def layers_of(case: BarCase, rod: Rod) -> dict[str, EndLayer]:
    """The layers beyond the ends of a bar, by side."""
    found = {}
    for index, side in enumerate(ENDS):
        if layer := case.side(side).layer:
            end = rod.end(side)
            stiffness = end.stiffness_beyond(index, case.method.begin(rod).influence)
            away = np.arange(len(stiffness))[::-1]
            inner = away if side == "left" else end.last - away
            mass = end.density * end.section * end.spacing
            found[side] = EndLayer(side, layer, inner, stiffness, mass, end.spacing, end.speed, end.drag_rate)
    return found


def continued(
    layers: Mapping[str, EndLayer], bands: np.ndarray, mass: np.ndarray, held: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness bands (b, n') N/m, masses (n',) kg and held nodes of a bar and its layers, in their order along it.

    bands (b, n), mass (n,), held (h,) : of the bar without layers.
    """
    if not layers:
        return bands, mass, held
    left, right = (layers[side].layer.nodes if side in layers else 0 for side in ENDS)
    n = len(mass)
    rows = max(len(bands), *(len(each.inner) + 1 for each in layers.values()))
    joined = np.zeros((rows, left + n + right))
    joined[: len(bands), left : left + n] = bands
    for side, each in layers.items():
        own = each.bands()
        for d, band in enumerate(own):
            band = band[: len(band) - d]
            if side == "left":
                joined[d, : len(band)] += band[::-1]
            else:
                first = left + n - len(each.inner)
                joined[d, first : first + len(band)] += band
    masses = [layers[side].mass if side in layers else 0.0 for side in ENDS]
    return joined, np.concatenate([np.full(left, masses[0]), mass, np.full(right, masses[1])]), held + left


class LayerTie(Tie):
    """The layers of a bar of n nodes, at rest, to be stepped by Δt (s).

    Attributes
    ----------
    through : (n − 1,) N, see kernels.tables.BarLayers.
    """

    name = "layers"

    def __init__(self, layers: Sequence[EndLayer], count: int, time_step: float) -> None:
        self._layers = layers
        self._bundle = _laid_out(layers, count, time_step)
        self.through = self._bundle.through
        self.nodes = np.unique(self._bundle.inner)

    def bundle(self, supported: np.ndarray) -> BarLayers:
        """The arrays for the kernels."""
        return self._bundle._replace(line=np.searchsorted(supported, self._bundle.inner))

    def saved_arrays(self) -> Arrays:
        """Motion of the layers' nodes, and forces of their bonds."""
        arrays = self._bundle
        return {name: getattr(arrays, name) for name in ("velocity", "displacement", "force", "through")}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        for name, values in self.saved_arrays().items():
            values[...] = saved[name]


def _laid_out(layers: Sequence[EndLayer], count: int, step: float) -> BarLayers:
    """The layers of a bar of n nodes at rest for the kernels."""
    reach, longest = len(layers[0].inner), max(each.count for each in layers)
    ends, rows = (len(layers), longest), (len(layers), reach, longest)
    inner = np.stack([each.inner for each in layers])
    outwards = np.array([-1.0 if each.side == "left" else 1.0 for each in layers])
    plane = inner[:, :-1] - (outwards[:, None] < 0.0)
    of_nodes = {name: np.zeros(ends) for name in ("velocity", "displacement", "keep", "mobility", "ground")}
    of_bonds = {name: np.zeros(rows) for name in ("force", "bond_keep", "bond_gain")}
    across = {"pull": np.zeros(longest), "through": np.zeros(count - 1)}
    arrays = BarLayers(
        inner=inner, line=inner, plane=plane, outwards=outwards, step=step, **of_nodes, **of_bonds, **across
    )
    for e, each in enumerate(layers):
        own, half = slice(0, each.count), 0.5 * step
        node, drag, bond = half * each.node_rates, half * each.drag_rate, half * each.bond_rates
        arrays.bond_keep[e, :, own] = (1.0 - bond) / (1.0 + bond)
        arrays.bond_gain[e, :, own] = step * each.bonds / (1.0 + bond)
        arrays.keep[e, own] = (1.0 - node) * (1.0 - drag) / ((1.0 + node) * (1.0 + drag))
        arrays.mobility[e, own] = step / (each.mass * (1.0 + node) * (1.0 + drag))
        arrays.ground[e, own] = each.ground
    return arrays

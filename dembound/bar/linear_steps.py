"""The steps of a linear bar and its layers as numpy arrays: its motion under single forces.

Bonds of bar and layers obey the same pair of equations (kernels/bar_layer.py); in the bar the rates of decay are
zero, and the dashpots of supported nodes stand in place of attenuation:

    f ← keep f + gain (v_j − v_i) ,    v ← keep v + mobility (F − ground u) .

So nothing has to be compiled, and as the steps are linear, the motion under any signal is that under one step of it,
convolved with the signal.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.lib.stride_tricks import as_strided

from dembound.bar.layers import EndLayer
from dembound.bar.scene import BarScene


class LinearSteps:
    """A bar with its bonds at the start, and layers beyond its ends, in steps of Δt (s).

    Attributes
    ----------
    first : number of the bar's first node among all, which are numbered from left to right. count : of the bar's nodes.
    """

    def __init__(self, scene: BarScene, layers: Mapping[str, EndLayer], step: float) -> None:
        bonds = scene.case.method.begin(scene.rod)
        left, right = (layers[side].layer.nodes if side in layers else 0 for side in ("left", "right"))
        self.first, self.count, self._step = left, scene.count, step
        nodes = left + scene.count + right
        own = slice(left, left + scene.count)
        reach = max([1, bonds.horizon, *(len(each.inner) for each in layers.values())])
        self._gain, self._bond_keep = np.zeros((reach, nodes)), np.ones((reach, nodes))
        self._gain[: bonds.horizon, own] = step * bonds.bond
        self._gain[0, left : left + scene.count - 1] += step * bonds.spring
        mass, damping, self._ground, decay = np.ones(nodes), np.zeros(nodes), np.zeros(nodes), np.zeros(nodes)
        mass[own], damping[own] = scene.mass, scene.rod.drag_rate * scene.mass
        supports = scene.supports
        along = supports.component == 0
        held = left + supports.node[along]
        damping[held], self._ground[held] = supports.damping[along], supports.stiffness[along]
        for side, layer in layers.items():
            end, outwards = (left, -1) if side == "left" else (left + scene.count - 1, 1)
            self._lay(layer, end + outwards * (np.arange(layer.count) - (len(layer.inner) - 1)), outwards)
            beyond = end + outwards * np.arange(1, layer.layer.nodes + 1)
            mass[beyond], damping[beyond] = layer.mass, layer.mass * layer.drag_rate
            decay[beyond] = layer.node_rates[len(layer.inner) :]
            self._ground[beyond] = layer.ground[len(layer.inner) :]
        half = 0.5 * step
        lost, slowed = half * decay, half * damping
        moves = np.ones(nodes)
        moves[held[supports.prescribed[along]]] = 0.0
        self._keep = moves * (1.0 - lost) * (mass - slowed) / ((1.0 + lost) * (mass + slowed))
        self._mobility = moves * step / ((1.0 + lost) * (mass + slowed))

    def _lay(self, layer: EndLayer, place: np.ndarray, outwards: int) -> None:
        """Add the bonds of a layer; place : the numbers of its nodes and of the bar nodes that it is bonded to."""
        half = 0.5 * self._step
        for row, (stiffness, rate) in enumerate(zip(layer.bonds, layer.bond_rates, strict=True)):
            begins = np.flatnonzero(stiffness > 0.0)
            here = place[begins] if outwards > 0 else place[begins + row + 1]
            self._gain[row, here] += self._step * stiffness[begins] / (1.0 + half * rate[begins])
            self._bond_keep[row, here] = (1.0 - half * rate[begins]) / (1.0 + half * rate[begins])

    def after(self, force: np.ndarray, motion: np.ndarray, steps: int) -> np.ndarray:
        """Velocities (steps, n) m/s of the bar's nodes after forces (n,) N, and motions (n,) m/s, of the first step.

        motion : of nodes whose motion is prescribed, 0 for others.
        """
        reach, nodes = self._gain.shape
        own = slice(self.first, self.first + self.count)
        padded, pulled = np.zeros(nodes + reach), np.zeros((reach, nodes + reach))
        v, u, f = padded[:nodes], np.zeros(nodes), pulled[:, reach:]
        # row p − 1 of `ahead` has v at i + p, of `behind` the force of the bond that begins at i − p
        ahead = as_strided(padded[1:], (reach, nodes), (padded.itemsize, padded.itemsize), writeable=False)
        row, column = pulled.strides
        behind = as_strided(pulled[:, reach - 1 :], (reach, nodes), (row - column, column), writeable=False)
        found = np.empty((steps, self.count))
        for number in range(steps):
            f *= self._bond_keep
            f += self._gain * (ahead - v)
            pull = f.sum(axis=0) - behind.sum(axis=0) - self._ground * u
            if number == 0:
                pull[own] += force
            v *= self._keep
            v += self._mobility * pull
            if number == 0:
                v[own] += motion
            u += self._step * v
            found[number] = v[own]
        return found

"""Matched layers beyond the ends of a bar, in which velocities and bond forces decay at the same rate.

With the rate d of a node or of the middle of a bond, and γ of the bar's own dashpots, nodes and bonds obey

    m (dv/dt + (d + γ) v + dγ u) = F,    df/dt + d f = k (v_j − v_i) ,

for every bond of the layer and every one that reaches into it from the bar (bar/layers.py). Both are centred in time,
with u as the mean ¼(u⁻ + 2u + u⁺) of three steps, and h = Δt/2:

    f ← [(1 − dh) f + kΔt (v_j − v_i)] / (1 + dh)
    v ← [(1 − dh)(1 − γh) v + Δt (F/m − dγu)] / ((1 + dh)(1 + γh))

The discrete layer is then also the bar with D + d in place of D = (2/Δt) tanh(Δt ∂t/2), at every frequency.
"""

from numba import njit

from dembound.kernels.common import FAST, REST, U
from dembound.kernels.law import is_tie
from dembound.kernels.tables import BarLayers


@njit(**FAST)
def _stretch(w, p, inner, keep, gain, force, pull):
    """Advance the forces (N) of the bonds of length p by a step, and add them to the forces pull (s,) on the nodes."""
    first, last = U(max(0, inner - p)), U(w.size - p)
    p = U(p)
    for i in range(first, last):
        f = keep[i] * force[i] + gain[i] * (w[i + p] - w[i])
        f = 0.0 if abs(f) <= REST else f
        force[i] = f
        pull[i] += f
    for i in range(first, last):
        pull[i + p] -= force[i]


@njit(**FAST)
def _move(e, layers):
    """Move the layer's own nodes by a step."""
    w, shift, pull = layers.velocity[e], layers.displacement[e], layers.pull
    keep, mobility, ground = layers.keep[e], layers.mobility[e], layers.ground[e]
    for i in range(U(layers.inner.shape[1]), U(w.size)):
        x = keep[i] * w[i] + mobility[i] * (pull[i] - ground[i] * shift[i])
        x = 0.0 if abs(x) <= REST else x
        w[i] = x
        shift[i] += layers.step * x


@njit(**FAST)
def _note_planes(e, layers):
    """Write the tension (N) in a layer's bonds across the bar's planes."""
    inner = layers.inner.shape[1]
    for i in range(inner - 1):
        total = 0.0
        for p in range(1, inner + 1):
            for first in range(max(0, inner - p, i - p + 1), i + 1):
                total += layers.force[e, p - 1, first]
        layers.through[layers.plane[e, i]] = layers.outwards[e] * total


@njit(**FAST)
def _step(e, layers, x, force):
    """Advance a layer by a step, see `across_layers`; x (n,) m/s."""
    inner = layers.inner.shape[1]
    w, pull = layers.velocity[e], layers.pull
    for i in range(inner):
        w[i] = x[layers.inner[e, i]]
    for i in range(w.size):
        pull[i] = 0.0
    for p in range(1, inner + 1):
        keep, gain = layers.bond_keep[e, p - 1], layers.bond_gain[e, p - 1]
        _stretch(w, p, inner, keep, gain, layers.force[e, p - 1], pull)
    for i in range(inner):
        force[layers.line[e, i], 0] += pull[i]
    _note_planes(e, layers)
    _move(e, layers)


@njit(**FAST)
def across_layers(layers, u, v, force):
    """Advance all layers by a step, and add to force (k, 3) the forces (N) of their bonds on the bar's nodes.

    v : (3, n) velocities half a step earlier.
    """
    for e in range(layers.inner.shape[0]):
        _step(e, layers, v[0], force)


is_tie(BarLayers, across=across_layers)

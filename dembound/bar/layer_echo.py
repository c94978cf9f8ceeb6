"""Exact reflection of a harmonic wave by a matched layer, for its steps, nodes and bonds.

In steps of Δt = 2h a motion e^{iωt} has δ = (2i/Δt) sin ωh in place of ∂t, and μ = cos ωh in place of means of two half
steps. By kernels/bar_layer.py nodes and bonds then obey

    m (δ + (d + γ)μ + dγμ²/δ) v = F,    (δ + dμ) f = k (v_j − v_i) ,

a system of linear equations with few bands for the velocities v. A force is put on a node between the layer and another
one on the other side that is `LONG`. The reflected wave is the difference from the motion by the same force between two
long layers, whose own echoes are some 1e-11. It is measured some nodes away, outside the near field of the layer.
"""

import math
from dataclasses import replace

import numpy as np

from dembound.bar.layers import EndLayer
from dembound.boundaries.layer import Layer

LONG = Layer(nodes=1500, power=3.0, reflection=1e-12)
"""A layer whose own reflection is negligible."""

BETWEEN = 100
"""Nodes between the layers."""

RUNS = 0.01
"""Smallest amplitude of the wave at the layer, over the motion under the force."""

WIDEST = 30
"""Longest bonds, in spacings, for which the reflection is computed; the time grows with the square."""


def returned(layer: EndLayer, frequency: float, time_step: float) -> float:
    """Velocity of the reflected wave over that of the arriving wave, at a frequency (Hz); time_step s.

    nan for frequencies at which no wave runs along the bar, and for bonds longer than `WIDEST`.
    """
    angle = math.pi * frequency * time_step
    if len(layer.inner) > WIDEST or not 0.0 < angle < 0.5 * math.pi:
        return math.nan
    long = replace(layer, layer=LONG)
    echo, endless = (_response(long, right, angle, time_step) for right in (layer, long))
    source, seen, end = LONG.nodes + BETWEEN // 2, LONG.nodes + 3 * BETWEEN // 4, LONG.nodes + BETWEEN
    if abs(endless[end]) < RUNS * abs(endless[source]):
        return math.nan
    lost = abs(endless[end] / endless[seen])  # by attenuation, on the way to the end, and on the way back
    return float(abs(echo[seen] / endless[seen] - 1.0) / lost**2)


def _response(left: EndLayer, right: EndLayer, angle: float, time_step: float) -> np.ndarray:
    """Complex velocities of all nodes from the left layer's outer end on, under a force halfway between the layers."""
    from scipy.linalg import solve_banded

    reach, nodes = len(left.inner), left.layer.nodes + BETWEEN + right.layer.nodes + 1
    change, mean = 2j / time_step * np.sin(angle), np.cos(angle)
    drag, place = left.drag_rate, np.arange(nodes, dtype=float)
    bands = np.zeros((2 * reach + 1, nodes), dtype=complex)
    rates = _rates(left, right, place)
    bands[reach] = left.mass * (change + (rates + drag) * mean + rates * drag * mean**2 / change)
    for p, stiffness in enumerate(left.stiffness, start=1):
        bond = stiffness / (change + _rates(left, right, place[:-p] + 0.5 * p) * mean)
        bands[reach, :-p] += bond
        bands[reach, p:] += bond
        bands[reach - p, p:] -= bond
        bands[reach + p, :-p] -= bond
    force = np.zeros(nodes, dtype=complex)
    force[left.layer.nodes + BETWEEN // 2] = 1.0
    return solve_banded((reach, reach), bands, force)


def _rates(left: EndLayer, right: EndLayer, place: np.ndarray) -> np.ndarray:
    """Rates of decay (1/s) at places from the left layer's outer end, in spacings."""
    first, last = left.layer.nodes, left.layer.nodes + BETWEEN
    of_left = left.layer.rates(first - place, left.spacing, left.speed)
    return of_left + right.layer.rates(place - last, right.spacing, right.speed)

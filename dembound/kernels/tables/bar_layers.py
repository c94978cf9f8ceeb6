"""Arrays of the matched layers beyond the ends of a bar."""

from typing import NamedTuple

import numpy as np


class BarLayers(NamedTuple):
    """Layers beyond q ends, each numbered outwards: b nodes of the bar, the end node last, and the layer's own.

    The shorter one of two layers is filled up with nodes at rest, s nodes in all. Row p − 1 of bonds has those between
    nodes i and i + p that reach into the layer.

    inner : (q, b) numbers of the bar's nodes; line : (q, b) lines of the support table that move them; plane :
    (q, b − 1) the planes of the bar on the outer side of these nodes; outwards : (q,) −1 beyond the left end, 1
    beyond the right. velocity : (q, s) m/s, half a step behind; displacement : (q, s) m; force : (q, b, s) N of the
    bonds on their inner nodes. bond_keep, bond_gain N·s/m : (q, b, s), the part of its force that a bond keeps in a
    step, and what a relative velocity adds. keep : (q, s) the part of their velocity that nodes keep in a step;
    mobility : (q, s) s/kg; ground : (q, s) N/m of springs to the ground. pull (s,) : work space. through : (n − 1,) N,
    tension in these bonds across the bar's planes. step : Δt in s.
    """

    inner: np.ndarray
    line: np.ndarray
    plane: np.ndarray
    outwards: np.ndarray
    velocity: np.ndarray
    displacement: np.ndarray
    force: np.ndarray
    bond_keep: np.ndarray
    bond_gain: np.ndarray
    keep: np.ndarray
    mobility: np.ndarray
    ground: np.ndarray
    pull: np.ndarray
    through: np.ndarray
    step: float

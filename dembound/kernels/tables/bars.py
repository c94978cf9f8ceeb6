"""Arrays of bars: matched layers beyond the ends, and bonds whose force falls as they open."""

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


class Softening(NamedTuple):
    """The bonds of a bar that open, b at most, of which the first listed[0] exist; see kernels/bar_cracks.py.

    part : (n − 1,) the range of each plane. laws : (r, 6), for every range the elongation (m) of a spring and the
    stretch at which it begins to open, the elongation w_c (m) at which it has no force left, and how its strength
    depends on the strain rate: share by which it rises for a tenfold rate, between a slowest and a fastest one (1/s).
    rise : share of the limit from which on the rate is measured.

    row, first : (b,) the row of each bond, −1 for local springs, and its first node; began : (b,) step in which it
    reached its limit; whole : (b,) N/m, its stiffness up to then; limit, apart, furthest : (b,) m, elongations at which
    it began, at which it has no force left, and the largest one so far; rate : (b,) 1/s, its strain rate when it began.
    b is 0 in a bar without a fracture energy. below : (m + 1, n) last step in which springs, and bonds by row, were
    below that share of their limit, −1 if none was seen, or (0, 0) without laws of rates.
    """

    part: np.ndarray
    laws: np.ndarray
    rise: float
    row: np.ndarray
    first: np.ndarray
    began: np.ndarray
    whole: np.ndarray
    limit: np.ndarray
    apart: np.ndarray
    furthest: np.ndarray
    rate: np.ndarray
    below: np.ndarray
    listed: np.ndarray

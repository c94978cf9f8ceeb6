"""Arrays of bonds whose force falls as they open."""

from typing import NamedTuple

import numpy as np


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

"""Points with data on them, as they are handed to ParaView."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Points in space, and cells between them that are all alike: vertices of one point or lines of two.

    points (n, 3) m; cells (m, 1) or (m, 2), numbers of points; point_data and cell_data : arrays (n, …) and (m, …) on
    them by name.
    """

    points: np.ndarray
    cells: np.ndarray
    point_data: Mapping[str, np.ndarray]
    cell_data: Mapping[str, np.ndarray] = field(default_factory=dict)

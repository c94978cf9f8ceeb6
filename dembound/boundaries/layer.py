"""The profile of a layer of nodes that absorbs, beyond an end of a bar."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Layer:
    """Nodes beyond an end that absorb.

    nodes : their number N; power : p of the profile; reflection : R0, the theoretical reflection from the layer's outer
    end.
    """

    nodes: int
    power: float
    reflection: float

    def rates(self, depth: np.ndarray, spacing: float, speed: float) -> np.ndarray:
        """Rates of decay d (1/s), of any shape, at depths below the end in spacings (m), for waves of a speed (m/s).

        d = (p + 1) c ln(1/R0)/(2L) (x/L)^p, L = NΔx: with it a wave decays by √R0 on the way to the outer end.
        """
        length = self.nodes * spacing
        largest = (self.power + 1.0) * speed * math.log(1.0 / self.reflection) / (2.0 * length)
        return largest * (np.maximum(depth, 0.0) / self.nodes) ** self.power

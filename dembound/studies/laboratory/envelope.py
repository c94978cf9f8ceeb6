"""The Mohr-Coulomb line through strengths at several pressures."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Envelope(NamedTuple):
    """Friction angle in degrees, cohesion (Pa), and the uniaxial strength (Pa) of the line σ1 = uniaxial + Nσ3."""

    friction_angle: float
    cohesion: float
    uniaxial: float

    @property
    def slope(self) -> float:
        """N = (1 + sin φ)/(1 − sin φ)."""
        sine = np.sin(np.radians(self.friction_angle))
        return float((1.0 + sine) / (1.0 - sine))


def fitted(pressures: Sequence[float], strengths: Sequence[float]) -> Envelope:
    """The line by least squares through largest stresses (Pa) at two or more different pressures (Pa)."""
    slope, uniaxial = np.polyfit(pressures, strengths, 1)
    root = np.sqrt(max(slope, 1e-12))
    angle = 2.0 * np.degrees(np.arctan(root)) - 90.0
    return Envelope(float(angle), float(uniaxial / (2.0 * root)), float(uniaxial))

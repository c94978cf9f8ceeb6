"""A side of the scene, and the medium that it represents."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.sides import Motion, normal_axis


@dataclass(frozen=True)
class BoundaryMedium:
    """The medium that a side represents.

    density kg/m³, bulk; p_wave_speed, s_wave_speed m/s, nominal; mirror_stiffness: diameters (k,) m -> stiffness of
    the contact and bond between disks at the side and their mirror images, normal (k,) N/m and bending (k,) N·m/rad.
    own_speeds: c_p and c_s of plane waves along the side's normal, m/s, nan where the motion is held; None if they are
    the nominal speeds.
    """

    density: float
    p_wave_speed: float
    s_wave_speed: float
    mirror_stiffness: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    own_speeds: Callable[[], tuple[float, float]] | None = None

    @property
    def shear_modulus(self) -> float:
        """G = ρc_s² in Pa."""
        return self.density * self.s_wave_speed**2

    @property
    def running_speeds(self) -> tuple[float, float]:
        """c_p and c_s of plane waves along the side's normal, m/s, nan where the motion is held."""
        return (self.p_wave_speed, self.s_wave_speed) if self.own_speeds is None else self.own_speeds()

    def matched(self, edge: "Edge") -> dict[Motion, float]:
        """β0 = (c_eff/c)·H/ΣD of an edge: own over nominal wave speed, times its length over the sum of diameters.

        With it the dashpots have the impedance ρc_eff of plane waves along the normal. nan where the motion is held.
        """
        nominal = (self.p_wave_speed, self.s_wave_speed)
        pairs = zip(self.running_speeds, nominal, strict=True)
        # without stiffness there is no wave, and any factor will do: the own speed is then 0, or nan
        p, s = (mine / given if given > 0.0 else mine + 1.0 for mine, given in pairs)
        return {"p": p / edge.diameter_sum_ratio, "s": s / edge.diameter_sum_ratio}

    def impedances(self, beta_p: float, beta_s: float, normal_axis: int) -> np.ndarray:
        """Dashpot constants per metre of boundary, (2,) in Pa·s/m: βρc, P along the normal, S across it."""
        along_normal = beta_p * self.density * self.p_wave_speed
        across = beta_s * self.density * self.s_wave_speed
        return np.array([along_normal, across] if normal_axis == 0 else [across, along_normal])


@dataclass(frozen=True)
class Edge:
    """One side of the scene: the exposed particles and the length of the side.

    side left, right, bottom or top; nodes (k,) particle indices; positions (k, 2) m; diameters (k,) m; length m;
    shares (k,) of the particles' diameters that are inside the scene, see half_mass.py.
    """

    side: str
    nodes: np.ndarray
    positions: np.ndarray
    diameters: np.ndarray
    length: float
    shares: np.ndarray | float = 1.0

    @property
    def axis(self) -> int:
        """Axis of the normal: 0 for left and right, 1 for bottom and top."""
        return normal_axis(self.side)

    def only(self, chosen: np.ndarray, length: float) -> "Edge":
        """Some of its particles, chosen (k,) bool, on a part of the side of this length (m)."""
        shares = self.shares[chosen] if isinstance(self.shares, np.ndarray) else self.shares
        return Edge(self.side, self.nodes[chosen], self.positions[chosen], self.diameters[chosen], length, shares)

    @property
    def widths(self) -> np.ndarray:
        """(k,) m of the side on which the forces of the medium beyond act through each particle."""
        return self.diameters * self.shares

    @property
    def diameter_sum_ratio(self) -> float:
        """ΣD/H: the summed diameters over the length of the side; 1 for a row of touching equal disks."""
        return float(self.diameters.sum() / self.length)

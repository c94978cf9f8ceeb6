"""The elastic continuum: density and the six constants of a plane medium without any symmetry, and layers of media."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Medium:
    """A homogeneous plane medium, one metre thick.

    σ_xx = c11 ε_xx + c12 ε_yy + c16 γ,  σ_yy = c12 ε_xx + c22 ε_yy + c26 γ,  σ_xy = c16 ε_xx + c26 ε_yy + c66 γ,
    with γ = ∂_y u_x + ∂_x u_y.

    Attributes
    ----------
    density : kg/m³.
    c11, c22, c12, c66, c16, c26 : Pa.
    """

    density: float
    c11: float
    c22: float
    c12: float
    c66: float
    c16: float = 0.0
    c26: float = 0.0

    @classmethod
    def isotropic(cls, density: float, p_wave_speed: float, s_wave_speed: float) -> "Medium":
        """A medium of density (kg/m³) and wave speeds (m/s)."""
        p, s = density * p_wave_speed**2, density * s_wave_speed**2
        return cls(density, p, p, p - 2.0 * s, s)

    def times(self, factor: float) -> "Medium":
        """The medium with all moduli multiplied by a factor."""
        return Medium(self.density, *(factor * self.moduli))

    @property
    def moduli(self) -> np.ndarray:
        """(6,) Pa: c11, c22, c12, c66, c16, c26, the order of the kernels."""
        return np.array([self.c11, self.c22, self.c12, self.c66, self.c16, self.c26])

    @property
    def matrix(self) -> np.ndarray:
        """(3, 3) Pa: (ε_xx, ε_yy, γ) to (σ_xx, σ_yy, σ_xy)."""
        return np.array(
            [[self.c11, self.c12, self.c16], [self.c12, self.c22, self.c26], [self.c16, self.c26, self.c66]]
        )

    def plane_waves(self, direction: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        """Speeds (2,) m/s of the plane waves along a direction, ascending, and their unit polarisations in columns.

        Christoffel's equation: the eigenvalues of Γ_ik = C_ijkl n_j n_l are ρc².
        """
        x, y = np.asarray(direction) / np.hypot(*direction)
        strain = np.array([[x, 0.0], [0.0, y], [y, x]])  # of displacements along x and y
        squares, polarisations = np.linalg.eigh(strain.T @ self.matrix @ strain)
        return np.sqrt(squares / self.density), polarisations

    def normal_speed(self, axis: int) -> float:
        """Speed (m/s) of the faster plane wave along x (axis 0) or y (1): the P wave."""
        return float(self.plane_waves((1.0 - axis, float(axis)))[0][1])


@dataclass(frozen=True)
class Layered:
    """Ground of horizontal layers, each a homogeneous medium.

    Attributes
    ----------
    media : of the layers from the bottom up; the lowest one goes on downwards, and the highest one upwards.
    joints : heights y of the boundaries between them, ascending, m.

    Raises ValueError if there is not one joint less than media, or if joints do not ascend.
    """

    media: tuple[Medium, ...]
    joints: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if len(self.media) != len(self.joints) + 1:
            raise ValueError(f"{len(self.media)} layers have {len(self.media) - 1} joints, not {len(self.joints)}")
        if not np.all(np.diff(self.joints) > 0.0):
            raise ValueError("the joints of layers must ascend")

    @property
    def only(self) -> Medium:
        """The medium of ground that is not layered; raises ValueError for layers."""
        if self.joints:
            raise ValueError(f"needs one medium, not {len(self.media)} layers")
        return self.media[0]

    def number_at(self, heights: np.ndarray) -> np.ndarray:
        """Number (k,) of the layer at heights (k,) m, from the bottom; on a joint the lower one."""
        return np.searchsorted(self.joints, heights)

    def at(self, height: float) -> Medium:
        """The medium at a height, m."""
        return self.media[int(self.number_at(np.array([height]))[0])]


Ground = Medium | Layered
"""What a continuum consists of: one medium, or layers of several."""


def layered(ground: Ground) -> Layered:
    """The layers of a ground; one medium is a single layer."""
    return ground if isinstance(ground, Layered) else Layered((ground,))

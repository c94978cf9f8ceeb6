"""The elastic continuum: density, the six constants of a plane medium, and its plane waves at any angle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

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
    def isotropic(cls, density: float, p_wave_speed: float, s_wave_speed: float) -> Medium:
        """A medium of density (kg/m³) and wave speeds (m/s)."""
        p, s = density * p_wave_speed**2, density * s_wave_speed**2
        return cls(density, p, p, p - 2.0 * s, s)

    def times(self, factor: float) -> Medium:
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


@dataclass(frozen=True)
class Unlike:
    """Ground whose layers differ left and right of a body, below which they are the same.

    Attributes
    ----------
    left, right : the layers of either side; media are numbered from the bottom, those of the left first.
    """

    left: Layered
    right: Layered

    @property
    def media(self) -> tuple[Medium, ...]:
        """The media of the left side, then those of the right one, each from the bottom up."""
        return self.left.media + self.right.media

    @property
    def joints(self) -> tuple[float, ...]:
        """The heights of the boundaries at either side, ascending, m."""
        return tuple(sorted({*self.left.joints, *self.right.joints}))

    @property
    def between_joints(self) -> tuple[tuple[Medium, Medium], ...]:
        """The media left and right between each two of the joints of either side, from the bottom up."""
        ends = (*self.joints, np.inf)
        each = [
            [side.media[int(np.searchsorted(side.joints, end))] for end in ends] for side in (self.left, self.right)
        ]
        return tuple(zip(*each, strict=True))

    def number_at(self, heights: np.ndarray, is_right: np.ndarray) -> np.ndarray:
        """Number (k,) of the medium at heights (k,) m, of the right side or of the left one; on a joint the lower."""
        return np.where(is_right, len(self.left.media) + self.right.number_at(heights), self.left.number_at(heights))

    @property
    def only(self) -> Medium:
        """Raises ValueError, as ground that is not layered has one."""
        raise ValueError("needs one medium, not layers")

    def at(self, height: float) -> Medium:
        """The medium at a height (m) at which both sides are the same; raises ValueError elsewhere."""
        one, other = self.left.at(height), self.right.at(height)
        if one != other:
            raise ValueError(f"the media at y = {height:g} m are not the same at both sides")
        return one


Ground = Medium | Layered | Unlike
"""What a continuum consists of: one medium, layers of several, or layers that differ at its sides."""


def layered(ground: Ground) -> Layered | Unlike:
    """The layers of a ground; one medium is a single layer."""
    return one_side(ground) if isinstance(ground, Medium) else ground


def one_side(ground: Ground) -> Layered:
    """The layers of ground that is the same at both sides; raises ValueError for other ground."""
    if isinstance(ground, Unlike):
        raise ValueError("needs the layers of one side")
    return ground if isinstance(ground, Layered) else Layered((ground,))


WaveKind = Literal["p", "sv"]

EVANESCENT = 1e-7
"""Imaginary part of s_y over the largest |s_y| from which on a wave decays along y, and difference of two s_y below
which they coincide, as at the critical angle. Rounding makes coinciding roots differ by the root of 1e-16.
"""

NO_WAVE = 1e-10
"""Amplitude over that of the incident wave below which a reflected wave is rounding."""

GRAZING = 90.0
"""Angle (degrees) from the vertical at which a wave runs along the surface."""

SEARCHED = 1e-9
"""Accuracy (degrees) of critical angles."""


@dataclass(frozen=True)
class ElasticPlaneWave:
    """The displacement motion · g(t − delay − slowness·x), with g the displacement of a wave of the case.

    Attributes
    ----------
    slowness : s/m, along x and y. motion : along x and y per unit of g. delay : s, at the origin.
    """

    slowness: tuple[float, float]
    motion: tuple[float, float]
    delay: float = 0.0

    def delays(self, places: np.ndarray) -> np.ndarray:
        """Delays (k,) s at places (k, 2) m."""
        return self.delay + places @ np.array(self.slowness)

    def shifted(self, by: float) -> ElasticPlaneWave:
        """The wave, later by a time, s."""
        return replace(self, delay=self.delay + by)

    def flux(self, medium: Medium) -> np.ndarray:
        """Energy flux (2,) along x and y, W/m² per unit of ġ²: −σ·v."""
        xx, yy, xy = medium.matrix @ strain_of(*self.slowness) @ self.motion
        return np.array([[xx, xy], [xy, yy]]) @ self.motion


def strain_of(sx: complex, sy: complex) -> np.ndarray:
    """Strains (xx, yy, γ) of displacements along x and y of waves with this slowness, e (3, 2) per unit of −ġ."""
    return np.array([[sx, 0.0], [0.0, sy], [sy, sx]])


def traction_of(medium: Medium, sx: float, sy: float) -> np.ndarray:
    """(2, 2) from displacements along x and y to tractions along x and y on planes y = const, per unit of −ġ."""
    return (medium.matrix @ strain_of(sx, sy))[[2, 1]]


def incident_wave(medium: Medium, kind: WaveKind, angle: float) -> ElasticPlaneWave:
    """The wave of unit amplitude whose normal is at an angle (degrees) from the vertical, to the right if positive.

    "p" moves along its normal, forwards if positive, "sv" across it, to the right where it runs straight up. In
    anisotropic media these are the faster and the slower wave, which move nearly in these directions.
    """
    x, y = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    speeds, polarisations = medium.plane_waves((x, y))
    number = {"sv": 0, "p": 1}[kind]
    motion = polarisations[:, number]
    motion = motion * np.copysign(1.0, motion @ ((x, y) if kind == "p" else (y, -x)))
    return ElasticPlaneWave(_pair(np.array([x, y]) / speeds[number]), _pair(motion))


def vertical_slownesses(medium: Medium, sx: float, inertia: float = 1.0) -> np.ndarray:
    """The four s_y (4,) of waves with a horizontal slowness, s/m; complex where they are evanescent.

    inertia : part of the density that acts; with 0 they are those of static fields, over s_x the roots of Stroh.
    """
    across, up = strain_of(1.0, 0.0), strain_of(0.0, 1.0)
    c = medium.matrix
    constant = sx**2 * across.T @ c @ across - inertia * medium.density * np.eye(2)
    linear, square = sx * (across.T @ c @ up + up.T @ c @ across), up.T @ c @ up
    scale = np.sqrt(medium.density / medium.c66)  # roots of order one
    entries = np.stack([square * scale**2, linear * scale, constant], axis=-1) / medium.density
    determinant = np.convolve(entries[0, 0], entries[1, 1]) - np.convolve(entries[0, 1], entries[1, 0])
    return scale * np.roots(determinant)


def waves_with(medium: Medium, sx: float) -> tuple[list[ElasticPlaneWave], list[ElasticPlaneWave]] | None:
    """The two waves with a horizontal slowness (s/m) whose energy runs up, and the two whose energy runs down.

    They have unit amplitude; the slower one comes first. None if one of them is evanescent.
    """
    roots = vertical_slownesses(medium, sx)
    apart = np.abs(roots[:, None] - roots)[np.triu_indices(4, 1)]
    least = EVANESCENT * np.abs(roots).max()
    if np.abs(roots.imag).max() > least or apart.min() < least:
        return None
    up, down = list[ElasticPlaneWave](), list[ElasticPlaneWave]()
    for sy in roots.real:
        strain = strain_of(sx, sy)
        polarisation = np.linalg.svd(strain.T @ medium.matrix @ strain - medium.density * np.eye(2))[2][-1].real
        wave = ElasticPlaneWave((sx, float(sy)), _pair(polarisation))
        (down if wave.flux(medium)[1] < 0.0 else up).append(wave)
    for waves in (up, down):
        waves.sort(key=lambda wave: -np.hypot(*wave.slowness))
    return (up, down) if len(down) == 2 else None


def reflected_waves(
    medium: Medium, incident: ElasticPlaneWave, surface: float, mass: float = 0.0
) -> list[ElasticPlaneWave] | None:
    """The waves that a free surface y = `surface` (m) reflects; None beyond the critical angle.

    None also where the energy of the incident wave runs down, as that of flat P waves in anisotropic media may.

    mass : on the surface, kg/m². In the first order in ω·mass/(ρc) a reflected wave is A g + A′ ġ: the sum of two waves
    with A/2 ± A′/ε whose delays differ by ε, the travel time of waves through a thickness of the medium with this mass.
    """
    sx, sy = incident.slowness
    all_four = waves_with(medium, sx)
    if all_four is None or incident.flux(medium)[1] <= 0.0:
        return None
    waves = all_four[1]
    motions = np.array([wave.motion for wave in waves]).T
    tractions = np.column_stack([traction_of(medium, *wave.slowness) @ wave.motion for wave in waves])
    amplitudes = np.linalg.solve(tractions, -traction_of(medium, sx, sy) @ incident.motion)
    found = []
    # Σ tractions·ġ = m Σ motions·g̈ on the surface, so that A′ follows from the motion of that without a mass
    later = np.linalg.solve(tractions, mass * (np.array(incident.motion) + motions @ amplitudes))
    apart = mass / medium.density * float(np.hypot(sx, sy))
    for wave, amplitude, change in zip(waves, amplitudes, later, strict=True):
        at_once = incident.delay + (sy - wave.slowness[1]) * surface  # the same at the surface as the incident one
        moved = np.array(wave.motion)
        if mass == 0.0:
            pairs = [(float(amplitude), 0.0)]
        else:
            pairs = [(0.5 * amplitude + change / apart, -0.5 * apart), (0.5 * amplitude - change / apart, 0.5 * apart)]
        for factor, shift in pairs:
            if abs(factor) > NO_WAVE:
                found.append(ElasticPlaneWave(wave.slowness, _pair(factor * moved), at_once + shift))
    return found


def critical_angle(medium: Medium, kind: WaveKind, sign: float = 1.0, above: Medium | None = None) -> float:
    """Smallest angle (degrees) to the right (sign 1) or left (−1) at which a reflected wave is evanescent.

    90 if there is none, as for P waves of isotropic media. above : of a layer, of which one wave then is evanescent.
    """

    def is_critical(angle: float) -> bool:
        incident = incident_wave(medium, kind, sign * angle)
        if above is not None:
            return waves_with(above, incident.slowness[0]) is None
        return reflected_waves(medium, incident, 0.0) is None

    angles = np.arange(0.0, GRAZING, 0.25)
    beyond = np.array([is_critical(angle) for angle in angles])
    if not beyond.any():
        return GRAZING
    high = float(angles[np.argmax(beyond)])
    low = max(high - 0.25, 0.0)
    while high - low > SEARCHED:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_critical(middle) else (middle, high)
    return high


def _pair(vector: np.ndarray) -> tuple[float, float]:
    """A vector (2,) as a tuple."""
    x, y = vector.tolist()
    return x, y

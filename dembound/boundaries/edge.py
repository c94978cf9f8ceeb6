"""The sides of a scene: their normals, their particles, and the medium that a side represents."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dembound.table import Box

SIDES = ("left", "right", "bottom", "top")

Motion = Literal["p", "s"]
"""Kind of wave: P moves particles along the normal of the side it reaches, S across it."""

Factor = float | Literal["matched"]
"""Factor β of a side's dashpots as given: a number, or "matched" to absorb plane waves along the normal."""

OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
"""Side -> the side across the scene."""


def normal_axis(side: str) -> int:
    """Axis of a side's normal: 0 for left and right, 1 for bottom and top."""
    return 0 if side in ("left", "right") else 1


def is_far(side: str) -> bool:
    """Whether a side is at the far end of its axis: right or top."""
    return side in ("right", "top")


def plane_of(side: str, box: Box) -> float:
    """Position (m, along its normal) of a side of a box."""
    return box[normal_axis(side) + 2 * is_far(side)]


def axis_of_motion(side: str, motion: Motion) -> int:
    """Axis along which a wave moves the particles of a side at normal incidence."""
    return normal_axis(side) if motion == "p" else 1 - normal_axis(side)


SAMPLES_PER_RADIUS = 100
"""Lines of sight per smallest radius: a disk that shows less than 1 % of it counts as hidden."""

DEPTH = 4.0
"""Largest distance of a side's disk from the outermost face, in largest radii.

It is large enough for every hole of a dense packing, and too small for lines of sight that pass a rough corner and
cross the whole scene.
"""

AT_ONCE = 1024
"""Disks whose lines of sight are computed together, some hundred each."""

LEVEL = 1e-6
"""Largest deviation of the centres of one row from a line, in smallest radii: rounding errors."""


def outer_row(positions: np.ndarray, radii: np.ndarray, side: str) -> np.ndarray:
    """Indices of the particles in the outermost row at `side`, sorted along it; parameters of `exposed`.

    If the disks of a side form one row, this is the whole side. `exposed` may also return disks at a corner: every
    second row of a hexagonal packing extends beyond the others.
    """
    axis = normal_axis(side)
    outward = _sign(side) * positions[:, axis]
    nodes = np.flatnonzero(outward > outward.max() - LEVEL * radii.min())
    return nodes[np.argsort(positions[nodes, 1 - axis], kind="stable")]


def exposed(positions: np.ndarray, radii: np.ndarray, side: str, period: float | None = None) -> np.ndarray:
    """Indices of the particles visible from outside `side`, sorted along it.

    A depth buffer over parallel lines of sight. positions (n, 2) and radii (n,) in m; side is left, right, bottom
    or top; period (m) is the scene's length along the side when it is periodic there, else None.
    """
    axis = normal_axis(side)
    outward, along = _sign(side) * positions[:, axis], positions[:, 1 - axis]
    front = outward + radii
    near = np.flatnonzero(front > front.max() - DEPTH * radii.max())
    near = near[np.argsort(-front[near], kind="stable")]
    spacing = radii.min() / SAMPLES_PER_RADIUS
    origin = np.min(along[near] - radii[near])
    count = int(np.ceil((np.max(along[near] + radii[near]) - origin) / spacing)) + 1
    if period is not None:
        count = int(np.ceil(period / spacing))
        spacing = period / count
    depth = np.full(count, -np.inf)
    owner = np.full(count, -1)
    for some in np.split(near, range(AT_ONCE, len(near), AT_ONCE)):
        ends = along[some] - radii[some], along[some] + radii[some]
        number, line = _lines_of_sight(*((end - origin) / spacing for end in ends))
        disk = some[number]
        reach = radii[disk] ** 2 - (origin + line * spacing - along[disk]) ** 2
        face = outward[disk] + np.sqrt(np.maximum(reach, 0.0))
        if period is not None:
            line %= count
        seen = np.flatnonzero(face > depth[line])
        disk, line, face = disk[seen], line[seen], face[seen]
        np.maximum.at(depth, line, face)
        foremost = np.flatnonzero(face == depth[line])[::-1]  # of equal ones the first in `near` is written last
        owner[line[foremost]] = disk[foremost]
    nodes = np.unique(owner[owner >= 0])
    return nodes[np.argsort(along[nodes], kind="stable")]


def _lines_of_sight(begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (k,) of disks and of the lines of sight that meet them; ends (m,) of the disks in spacings of lines."""
    first, last = np.ceil(begin).astype(np.int64), np.floor(end).astype(np.int64)
    counts = last - first + 1
    before = np.cumsum(counts) - counts
    return np.repeat(np.arange(len(counts)), counts), np.arange(counts.sum()) + np.repeat(first - before, counts)


def _sign(side: str) -> float:
    """Direction of a side's outward normal along its axis."""
    return 1.0 if is_far(side) else -1.0


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

"""Reflection of plane waves by a viscous side against the angle of incidence, of the lattice and of the continuum.

The lattice's reflection is exact for its forces and dashpots: the couplings between neighbours, the masses and the
dashpots are those of a scene, a wave e^(i(k_y y − ωt)) makes of every column of disks three unknowns, the columns of
the half-space are superposed from its six waves, and the equation of the last column gives the reflected ones.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scenes import RADIUS, SPEED, disks
from scipy.linalg import eig

from dembound.disks.scene import DiskScene
from dembound.disks.stability import fill_forces

DIAMETER = 2.0 * RADIUS
ANGLES = np.arange(0.0, 86.0, 2.5)
"""Degrees from the normal."""


def lattice(side: Mapping[str, Any], fric: float = 0.5) -> DiskScene:
    """Five by seven disks with a side on the right; friction makes k_s = k_n, an isotropic lattice with ν = 0."""
    return disks("A", (2.5, 3.5), material={"fric": fric}, boundary={"right": dict(side)})


def forces_by(scene: DiskScene, disk: int, component: int) -> np.ndarray:
    """Forces (3, n) of a unit displacement of one disk."""
    u = np.zeros((3, scene.count))
    u[component, disk] = 1.0
    u = scene.layout.spread(u)
    force = np.zeros_like(u)
    fill_forces(scene, u, force)
    return scene.layout.gather(force)


def couplings(scene: DiskScene, column: int) -> list[tuple[int, int, np.ndarray]]:
    """Columns and rows from a disk of `column` to each neighbour and itself, and the forces (3, 3) on it per motion."""
    x, y = np.round(scene.positions.T / DIAMETER - 0.5).astype(int)
    disk = int(np.flatnonzero((x == column) & (y == 3))[0])
    return [
        (
            int(x[other] - column),
            int(y[other] - 3),
            np.stack([forces_by(scene, int(other), component)[:, disk] for component in range(3)], axis=1),
        )
        for other in np.flatnonzero((abs(x - column) <= 1) & (abs(y - 3) <= 1))
    ]


def column_matrices(couplings: list[tuple[int, int, np.ndarray]], wavenumber: float) -> dict[int, np.ndarray]:
    """For a wave along y: offset of a column -> matrix (3, 3) of forces on a disk per displacement of the column."""
    found: dict[int, np.ndarray] = {}
    for across, up, block in couplings:
        phase = np.exp(1j * wavenumber * DIAMETER * up)
        found[across] = found.get(across, np.zeros((3, 3), complex)) + phase * block
    return found


def waves(inner: Mapping[int, np.ndarray], mass: np.ndarray, frequency: float) -> tuple[np.ndarray, ...]:
    """Factors (6,) from column to column, shapes (3, 6) and energy flows (6,) of the waves in the lattice."""
    ahead = inner[1]
    total = inner[-1] + inner[0] + ahead + frequency**2 * np.diag(mass)
    slope = ahead - inner[-1] + total
    zero, one = np.zeros((3, 3)), np.eye(3)
    # factors 1 + ε of long waves are close to each other; those of the equation for ε/κ, κ the phase of P, are not
    unit = frequency * DIAMETER / SPEED
    size = np.abs(ahead).max()
    left = np.block([[zero, one], [-total / (size * unit**2), -slope / (size * unit)]])
    right = np.block([[one, zero], [zero, ahead / size]])
    small, vectors = eig(left, right)
    factor = 1.0 + unit * small
    shape = vectors[:3] / np.linalg.norm(vectors[:3], axis=0)
    flow = np.imag(factor * np.einsum("im,ij,jm->m", shape.conj(), ahead, shape))
    return factor, shape, flow


def reflection(
    side: Mapping[str, Any], motion: str, angle: float, per_wavelength: float = 200.0, fric: float = 0.5
) -> dict[str, float]:
    """Reflected amplitudes "p", "s" and energy of a plane wave on a side, as parts of the incident one.

    motion : "p" or "s"; angle : degrees from the normal; per_wavelength : disks in a wavelength.
    """
    scene = lattice(side, fric)
    x = np.round(scene.positions[:, 0] / DIAMETER - 0.5)
    speed = scene.ground.wave_speeds(0)[0 if motion == "p" else 1]
    frequency = 2.0 * np.pi * speed / (per_wavelength * DIAMETER)
    along = frequency / speed * np.sin(np.radians(angle))
    inertia = np.stack([scene.mass, scene.mass, scene.inertia])
    factor, shape, flow = waves(column_matrices(couplings(scene, 2), along), inertia[:, x == 2][:, 3], frequency)
    runs = np.abs(np.abs(factor) - 1.0) < 1e-8
    turns = np.abs(np.angle(factor))
    incoming = np.flatnonzero(runs & (flow > 0.0))
    incoming = incoming[np.argsort(turns[incoming])][0 if motion == "p" else -1]
    leaving = np.flatnonzero(np.where(runs, flow < 0.0, np.abs(factor) > 1.0))
    edge = column_matrices(couplings(scene, 4), along)
    disk = int(np.flatnonzero(x == 4)[3])
    rows = scene.supports
    damping = np.zeros(3)  # springs are in the forces
    damping[rows.component[rows.node == disk]] = rows.damping[rows.node == disk]
    own = edge[0] + np.diag(frequency**2 * inertia[:, disk] + 1j * frequency * damping)

    def at_the_edge(wave: np.ndarray | int) -> np.ndarray:
        return edge[-1] @ (shape[:, wave] / factor[wave]) + own @ shape[:, wave]

    amplitude = np.linalg.solve(at_the_edge(leaving), -at_the_edge(int(incoming)))
    shares = np.where(runs[leaving], np.abs(amplitude) ** 2 * -flow[leaving] / flow[incoming], 0.0)
    running = leaving[runs[leaving]]
    order = running[np.argsort(turns[running])]
    kinds = dict(zip(("p", "s") if len(order) == 2 else ("s",), order, strict=True))
    displacements = np.linalg.norm(shape[:2], axis=0)
    sizes = {
        kind: float(np.abs(amplitude[leaving == wave][0]) * displacements[wave] / displacements[incoming])
        for kind, wave in kinds.items()
    }
    return {"p": 0.0, "s": 0.0} | sizes | {"energy": float(shares.sum())}


def dashpot_formula(motion: str, angle: float, ratio: float = 0.5**0.5) -> dict[str, float]:
    """Reflection of an elastic continuum with matched dashpots; ratio : c_s/c_p. Units in which ω = ρ = c_p = 1.

    P moves along its wave vector (k_x, k_y), S across it; the tractions at the side are σ_xx = −ρc_p v_x and
    σ_xy = −ρc_s v_y.
    """
    slow = np.sin(np.radians(angle)) / (1.0 if motion == "p" else ratio)
    p_x, s_x = (np.sqrt(complex(1.0 / speed**2 - slow**2)) for speed in (1.0, ratio))
    shear = ratio**2

    def column(k_x: complex, is_p: bool) -> np.ndarray:
        """Tractions plus dashpots of a wave of unit amplitude, over iω."""
        size = 1.0 if is_p else 1.0 / ratio
        u = np.array([k_x, slow] if is_p else [-slow, k_x]) / size
        normal = k_x * u[0] + (1.0 - 2.0 * shear) * slow * u[1]
        across = shear * (slow * u[0] + k_x * u[1])
        return np.array([normal - u[0], across - ratio * u[1]])

    incident = column(p_x if motion == "p" else s_x, motion == "p")
    matrix = np.stack([column(-p_x, True), column(-s_x, False)], axis=1)
    p, s = np.abs(np.linalg.solve(matrix, -incident))
    flows = np.array([p_x.real, shear * s_x.real])  # of energy along x, of unit amplitudes: ρc²k_x
    share = (np.array([p, s]) ** 2 * flows).sum() / flows[0 if motion == "p" else 1]
    return {"p": float(p) if p_x.real else 0.0, "s": float(s), "energy": float(share)}

"""The front of waves in a packing: speed of the fastest waves, and the precursors ahead of them."""

from functools import lru_cache

import numpy as np

from dembound.disks.material.packed_material import PackedMaterial
from dembound.laws import Law, Moduli
from dembound.motion.paths import Front
from dembound.packings.square import Square

DIRECTIONS = 180
"""Directions in a half plane in which plane waves are computed, 1° apart: largest speeds are exact to some 4e-5."""

WAVE_NUMBERS = 48
"""Wave numbers along each axis for which waves of the square lattice are computed."""

SHARE = 0.98
"""Largest share of the stability limit in this computation; at the limit, group speeds of single waves are infinite."""

INDEX = np.array([[0, 2], [3, 1]])
"""Index of the displacement gradient ∂u_a/∂b in homogenised matrices, see homogenise.GRADIENTS."""


def front_of(ground: PackedMaterial, safety: float) -> Front:
    """The fastest waves of a packing, in the fastest of its layers, stepped with a share of the stability limit.

    Long waves of any direction have the speeds of the homogenised packing. Short waves may be faster, such as waves of
    rotation between wide bonds: their largest group speed is computed on the square lattice of the same material, and
    the packing's speed is multiplied by its ratio to that of the lattice's long waves. Of layers the fastest counts.
    """
    return max((_front_in(layer, safety) for layer in ground.materials), key=lambda front: front.speed)


def _front_in(ground: PackedMaterial, safety: float) -> Front:
    """The fastest waves of uniform ground."""
    grain, speed = float(np.hypot(*ground.brick.vectors.T).max()), largest_phase_speed(ground)
    if speed == 0.0:
        return Front(0.0, grain)
    ratio = _largest_ratio(
        ground.density, ground.moduli, ground.law, ground.held, 0.5 * ground.brick.mean_diameter, min(safety, SHARE)
    )
    return Front(max(1.0, ratio) * np.sqrt(ground.unrelaxed) * speed, grain)


@lru_cache(maxsize=64)
def _largest_ratio(
    density: float, moduli: Moduli, law: Law, held: tuple[int, ...], radius: float, safety: float
) -> float:
    """Largest group speed of all waves of the square lattice of a material over the speed of its fastest long waves."""
    lattice = PackedMaterial(Square(bricks=(1, 1), radius=radius).pack(1.0), density, moduli, law, held)
    return largest_group_speed(lattice, safety) / largest_phase_speed(lattice)


def slowest_speed(ground: PackedMaterial, *heights: float) -> float:
    """Speed (m/s) of the slowest long plane waves that run along x or y; nan if none does.

    heights : m, of which the layers count; by default all.
    """
    each = [ground.at(height) for height in heights] or [ground]
    speeds = [speed for one in each for axis in (0, 1) for speed in one.wave_speeds(axis) if np.isfinite(speed)]
    return min(speeds, default=float("nan"))


def largest_phase_speed(ground: PackedMaterial) -> float:
    """Speed (m/s) of the fastest long plane waves of any direction, under the scene's held motions; 0 if none can run.

    The largest eigenvalue of the Christoffel matrix Γ_ab = C_aibj n_i n_j, over all directions n. The fastest phase
    speed is also the fastest group speed, as both agree in the direction in which they are largest.
    """
    free = [axis for axis in (0, 1) if axis not in ground.held]
    angle = np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    christoffel = _christoffel(ground.tensor, angle)[:, free][:, :, free]
    return float(np.sqrt(np.linalg.eigvalsh(christoffel).max(initial=0.0) / ground.density))


def phase_speeds(ground: PackedMaterial, angle: np.ndarray) -> np.ndarray:
    """Speeds (k, 2) m/s of long plane P and S waves at angles (k,) from x, in a body that moves freely."""
    squares = np.linalg.eigvalsh(_christoffel(ground.material_tensor, angle))
    return np.asarray(np.sqrt(squares[:, ::-1] / ground.density))


def _christoffel(tensor: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Christoffel matrices (k, 2, 2) Pa of a homogenised tensor for waves at angles (k,) from x."""
    normal = np.stack([np.cos(angle), np.sin(angle)])
    stiffness = tensor[INDEX[:, :, None, None], INDEX]  # (a, i, b, j)
    return np.asarray(np.einsum("aibj,ik,jk->kab", stiffness, normal, normal))


def largest_group_speed(lattice: PackedMaterial, safety: float) -> float:
    """Largest group speed (m/s) of all waves of a square lattice, stepped with a share of the stability limit.

    A wave of displacements e exp(iq·x − iωt), e scaled to unit mass, elongates contacts by B(q)e, so that D = B†KB with
    eigenvalues ω². Its group speed along an axis is ∂ω/∂q = Re(e†B†K ∂B/∂q e)/ω. In time, central differences make
    it faster by 1/√(1 − (ωΔt/2)²).
    """
    wave_numbers = np.pi * (np.arange(-WAVE_NUMBERS, WAVE_NUMBERS) + 0.5) / WAVE_NUMBERS
    qx, qy = (grid.ravel() for grid in np.meshgrid(wave_numbers, wave_numbers))
    springs, strain, slopes = _strains(qx, qy, lattice)
    squares, modes = np.linalg.eigh(np.einsum("kca,c,kcb->kab", strain.conj(), springs, strain))
    frequency = np.sqrt(np.maximum(squares, 1e-12 * squares.max()))
    pulled = springs[:, None] * (strain @ modes)
    along = [np.einsum("kcm,kcm->km", pulled.conj(), slope @ modes).real / frequency for slope in slopes]
    stepped = np.sqrt(1.0 - (safety * frequency / frequency.max()) ** 2 + 1e-12)
    return float((np.hypot(*along) / stepped).max())


def plane_wave_frequencies(lattice: PackedMaterial, direction: np.ndarray, phase: np.ndarray) -> np.ndarray:
    """Angular frequencies (k, m) rad/s of plane waves on a square lattice, not stepped in time, the lowest first.

    direction : (2,) unit vector. phase : wave numbers (k,) in radians per disk. m : number of components that are free;
    the first that are not held of S and P waves are the translations, the last is the rotation of disks.
    """
    qx, qy = np.outer(direction, phase)
    springs, strain, _ = _strains(qx, qy, lattice)
    squares = np.linalg.eigvalsh(np.einsum("kca,c,kcb->kab", strain.conj(), springs, strain))
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def _strains(
    qx: np.ndarray, qy: np.ndarray, lattice: PackedMaterial
) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, ...]]:
    """Springs (6,) of a lattice's contacts, their elongations (k, 6, m) by free motions of unit mass, and slopes."""
    free = [component for component in range(3) if component not in lattice.held]
    springs = np.concatenate([getattr(lattice.stiffness, name) for name in ("normal", "shear", "bending")])
    size = np.sqrt([lattice.mass[0], lattice.mass[0], lattice.inertia[0]])
    strain, *slopes = (matrix[:, :, free] / size[free] for matrix in _elongations(qx, qy, lattice))
    return springs, strain, tuple(slopes)


def _elongations(qx: np.ndarray, qy: np.ndarray, lattice: PackedMaterial) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Matrices (k, 6, 3) for wave numbers (k,), in radians per disk, and their slopes by those in rad/m along x and y.

    Rows: normal elongations of the contacts along x and y, shear, bending. Phases are those of the contact points.
    """
    radius = float(lattice.brick.radii[0])
    matrices = np.zeros((3, len(qx), 6, 3), dtype=complex)
    for axis, q in enumerate((qx, qy)):
        difference, total = 2j * np.sin(0.5 * q), 2.0 * np.cos(0.5 * q)
        for matrix, one, both in (
            (matrices[0], difference, total),
            (matrices[1 + axis], 1j * radius * total, 1j * radius * difference),
        ):
            across = (1.0, -1.0)[axis]
            matrix[:, axis, axis] = one
            matrix[:, 2 + axis, 1 - axis] = across * one
            matrix[:, 2 + axis, 2] = -radius * both
            matrix[:, 4 + axis, 2] = one
    return matrices[0], matrices[1], matrices[2]

"""Waves in a packing: the front of the fastest, and reflection by copies of a random brick."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from dembound.continuum import sizing
from dembound.continuum.sizing import Signal
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.laws.law import Law, Moduli
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
    radius, safety = 0.5 * ground.brick.mean_diameter, min(safety, SHARE)
    ratio = _largest_ratio(ground.density, ground.moduli, ground.law, ground.held, radius, safety)
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


FAINT = 1e-6
"""Part of ω² of the longest waves by which everything is held, as a common motion of all copies meets no resistance."""

ROUNDING = 1e-9
"""Relative difference up to which wave lengths count as equal."""

LEFT_OUT = 1e-4
"""Share of the energy above the highest frequency considered; copies reflect some per cent of it."""

MOST_DISKS = 5_000
"""Most disks of a brick for which this is computed."""

SHORTEST = 6.0
"""Length in mean diameters of the shortest waves considered: disks beside shorter ones do not relax as at rest."""

WORK = 1e6
"""Most disks times right sides of the solves, some 1 s: 1,400 disks reach `SHORTEST`, 5,000 waves of 21 diameters."""

AT_ONCE = 16
"""Right sides that are solved together: more do not fit into the processor's cache."""


class Coupling(NamedTuple):
    """Coupling of the slower wave along an axis to the wave in the opposite direction.

    wavenumber : k, rad/m. frequency : Hz, at which copies reflect it in step. per_length : κ, 1/m.
    """

    wavenumber: float
    frequency: float
    per_length: float

    def band(self, length: float) -> float:
        """Width (Hz) of a band whose energy equals the energy reflected by a length (m) of copies."""
        speed = 2.0 * math.pi * self.frequency / self.wavenumber
        return 0.5 * speed * self.per_length * math.tanh(self.per_length * length)


class SentBack(NamedTuple):
    """What copies reflect.

    share : of velocities, RMS over RMS, of the signal with the largest. highest : frequency (Hz) up to which it
    is computed. above : share of the energy above that, the largest of the signals.
    """

    share: float
    highest: float
    above: float


def couplings(ground: PackedMaterial, numbers: Mapping[int, int]) -> Iterator[tuple[int, Coupling]]:
    """Axis (0 x, 1 y) and coupling of the waves along it with 1, 2, … half lengths in the brick.

    numbers : the largest number by axis.
    """
    even = {axis: range(2, last + 1, 2) for axis, last in numbers.items()}
    odd = [{axis: range(1, last + 1, 2)} for axis, last in numbers.items()]
    for alike in (even, *odd):
        if any(map(len, alike.values())):
            yield from _of_one_matrix(ground, alike)


def _of_one_matrix(ground: PackedMaterial, numbers: Mapping[int, range]) -> Iterator[tuple[int, Coupling]]:
    """The couplings of numbers by axis, all of them even, or odd along one axis."""
    from scipy.linalg import cholesky, solve_triangular

    size = ground.brick.size
    each = [(axis, number) for axis, several in numbers.items() for number in several]
    waves = {wave for axis, number in each for wave in _coupled(axis, number, size)}
    length = {wave: math.hypot(*(wave / size)) for wave in waves}
    ordered = sorted(waves, key=lambda wave: (length[wave], wave))
    lengths = np.array([length[wave] for wave in ordered])
    masses, flexibility = _matrices(ground, np.array(ordered), min(numbers))
    lower = cholesky(flexibility + np.diag(masses.diagonal() == 0.0), lower=True)  # the sine of no phase
    for axis, number in each:
        k = number * math.pi / float(size[axis])
        first = 4 * ordered.index((number, 0) if axis == 0 else (0, number))
        own, last = slice(first, first + 4), 4 * int(np.searchsorted(lengths, k / math.pi * (1.0 + ROUNDING)))
        half = solve_triangular(lower[:last, :last], masses[:last, own], lower=True)
        inverse = np.linalg.inv(np.linalg.cholesky(masses[own, own]))
        matrix = inverse @ half.T @ half @ inverse.T
        (cc, cs), (sc, ss) = matrix.reshape(2, 2, 2, 2).swapaxes(1, 2)
        omega2, polarisations = np.linalg.eigh(0.5 * (cc + ss + 1j * (cs - sc)))
        slower = polarisations[:, 0]
        shared = 0.5 * float(abs(slower.conj() @ (cc - ss - 1j * (cs + sc)) @ slower))
        yield axis, Coupling(k, math.sqrt(omega2[0]) / (2.0 * math.pi), k * shared / (2.0 * float(omega2[0])))


def _matrices(ground: PackedMaterial, waves: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """N and F (4w, 4w) of cosines and sines along x and y of waves (w, 2), see `_coupled`.

    axis : along which the numbers are odd, if they are.
    """
    from scipy.sparse import diags
    from scipy.sparse.linalg import splu

    brick, network = ground.brick, Network.of_brick(ground.brick, ground.stiffness)
    first, second = brick.positions[brick.pairs].swapaxes(0, 1)
    copies = np.rint((brick.vectors - (second - first)) / brick.size)[:, axis]
    mass = np.concatenate([ground.mass, ground.mass, ground.inertia])
    ways = network.motion_matrix((-1.0) ** (copies * waves[0, axis]))
    longest = math.pi / float(brick.size[axis]) * float(np.nanmin(ground.wave_speeds(axis)))
    stiffness = ways.T @ diags(network.springs) @ ways + FAINT * longest**2 * diags(mass)
    solver = splu(stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    angles = brick.positions @ (math.pi * waves / brick.size).T
    sizes = np.where(waves.any(axis=1), math.sqrt(2.0), 1.0)
    shapes = np.stack([np.cos(angles), np.sin(angles)], axis=-1) * sizes[:, None]
    moved = np.zeros((3, len(mass) // 3, *shapes.shape[1:], 2))  # component, disk, wave, cosine or sine, direction
    moved[0, ..., 0] = moved[1, ..., 1] = shapes
    moved = moved.reshape(len(mass), -1)
    pushed, flexibility = mass[:, None] * moved, np.empty((moved.shape[1], moved.shape[1]))
    for begin in range(0, moved.shape[1], AT_ONCE):
        some = slice(begin, begin + AT_ONCE)
        flexibility[:, some] = pushed.T @ solver.solve(pushed[:, some])
    return moved.T @ pushed, flexibility


def _coupled(axis: int, number: int, size: np.ndarray) -> set[tuple[int, int]]:
    """Half lengths along x and y in the brick of k, and of all waves that copies couple to it, with no longer vectors.

    Of two opposite waves there is one.
    """
    longest = number / size[axis] * (1.0 + ROUNDING)
    most = (longest * size).astype(int)
    begin = [-(m if m % 2 == number * (n == axis) % 2 else m - 1) for n, m in enumerate(most)]
    pairs = product(*(range(first, m + 1, 2) for first, m in zip(begin, most, strict=True)))
    return {max((x, y), (-x, -y)) for x, y in pairs if math.hypot(x / size[0], y / size[1]) <= longest}


def sent_back(
    ground: PackedMaterial, signals: Sequence[Signal], lengths: Sequence[float], axes: Sequence[int]
) -> SentBack:
    """What copies reflect of signals; computed for waves up to a length, and as far as `WORK` suffices.

    lengths : of the ground along x and y, m. axes : along which waves run; the mean over them is returned.
    """
    brick, shares = ground.brick, np.zeros(len(signals))
    speeds = {axis: float(np.nanmin(ground.wave_speeds(axis))) for axis in axes}
    most = math.sqrt(2.0 * math.pi * WORK / (3.0 * len(brick.radii) * float(np.prod(brick.size))))
    most = min(most, 2.0 * math.pi / (SHORTEST * brick.mean_diameter))
    highest = min(speeds.values()) * most / (2.0 * math.pi)
    cutoff = max(sizing.cutoff(signal, LEFT_OUT) for signal in signals)
    reached = min(cutoff, highest)
    numbers = {axis: math.floor(2.0 * reached / speed * float(brick.size[axis])) for axis, speed in speeds.items()}
    spectra = [sizing.energies(signal) for signal in signals]
    for axis, found in couplings(ground, numbers):
        band = found.band(lengths[axis]) / len(axes)
        for n, (frequencies, energy) in enumerate(spectra):
            whole = energy.sum() * (frequencies[1] - frequencies[0])
            shares[n] += band * (np.interp(found.frequency, frequencies, energy) / whole)
    above = max(float(energy[frequencies > reached].sum() / energy.sum()) for frequencies, energy in spectra)
    return SentBack(math.sqrt(min(float(shares.max()), 1.0)), reached, above if highest < cutoff else 0.0)

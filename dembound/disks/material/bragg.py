"""Reflection of plane waves by copies of a random brick, which the equivalent continuum does not have.

The stiffness varies within a random brick, and alike in all copies. Waves along an axis with half lengths that are the
brick's length L over a whole number m are reflected by all copies in step (Bragg's law). The two waves of opposite
directions, exp(±ikx) with k = mπ/L, are coupled. For given amplitudes a of them, and none of all longer waves that
copies couple to them, the brick has the least energy if everything else relaxes as at rest:

    ω² N a = N F⁻¹ N a,    N = Pᴴ M P,    F = Pᴴ M K(k)⁻¹ M P,

where the columns of P are unit translations along x and y with the phases of the waves, and K(k) is the stiffness of
the brick beside copies with the same motion and the phase of k. If V is the contribution of one wave to ω² of the
other, κ = kV/2ω² is their coupling per length. By the equations of coupled waves (Yariv 1973, IEEE J. Quantum Electron.
9, 919) a length l of copies reflects tanh²(κl) of the energy at Bragg's frequency, and over all frequencies, ∫|r|²df,
as much as a band ½cκ·tanh(κl) Hz wide has.

All waves of even m have the same periodic K, with real P of cosines and sines, and those of odd m along an axis the
same K beside copies of opposite motion. The waves of a number are among those of all larger numbers, so three solves
give F for all of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.outside import sizing
from dembound.outside.sizing import Signal

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
    shapes = (
        np.stack([np.cos(angles), np.sin(angles)], axis=-1) * np.where(waves.any(axis=1), math.sqrt(2.0), 1.0)[:, None]
    )
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
            density = np.interp(found.frequency, frequencies, energy) / (
                energy.sum() * (frequencies[1] - frequencies[0])
            )
            shares[n] += band * density
    above = max(float(energy[frequencies > reached].sum() / energy.sum()) for frequencies, energy in spectra)
    return SentBack(math.sqrt(min(float(shares.max()), 1.0)), reached, above if highest < cutoff else 0.0)

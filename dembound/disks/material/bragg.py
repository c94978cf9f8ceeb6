"""Reflection of plane waves by copies of a random brick, which the equivalent continuum does not have.

The stiffness varies within a random brick, and alike in all copies. Waves along an axis with half lengths that are the
brick's length L over a whole number m are reflected by all copies in step (Bragg's law). The two waves of opposite
directions, exp(±ikx) with k = mπ/L, are coupled. For given amplitudes a of them, and of all longer waves that copies
couple to them, the brick has the least energy if everything else relaxes as at rest:

    ω² N a = N F⁻¹ N a,    N = Pᴴ M P,    F = Pᴴ M K(k)⁻¹ M P,

where the columns of P are unit translations along x and y with the phases of the waves, and K(k) is the stiffness of
the brick beside copies with the same motion and the phase of k. If V is the contribution of one wave to ω² of the
other, κ = kV/2ω² is their coupling per length. By the equations of coupled waves (Yariv 1973, IEEE J. Quantum Electron.
9, 919) a length l of copies reflects tanh²(κl) of the energy at Bragg's frequency, and over all frequencies, ∫|r|²df,
as much as a band ½cκ·tanh(κl) Hz wide has.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.outside import sizing
from dembound.outside.sizing import Signal

FAINT = 1e-6
"""Part of ω² by which everything is held, as a common motion of all copies meets no resistance."""

ROUNDING = 1e-9
"""Relative difference up to which wave lengths count as equal."""

LEFT_OUT = 1e-4
"""Share of the energy above the highest frequency considered; copies reflect some per cent of it."""

MOST_DISKS = 5_000
"""Most disks of a brick for which this is computed: each coupling takes a solve for three unknowns per disk, some
0.3 s."""


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


def coupling(ground: PackedMaterial, axis: int, number: int) -> Coupling:
    """Coupling of the wave along an axis (0 x, 1 y) with `number` half lengths in the brick."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import splu

    brick, network = ground.brick, Network.of_brick(ground.brick, ground.stiffness)
    wavenumber = number * math.pi / float(brick.size[axis])
    k = wavenumber * np.eye(2)[axis]
    mass = np.concatenate([ground.mass, ground.mass, ground.inertia])
    ways = network.motion_matrix(np.exp(1j * network.vectors @ k))
    faint = FAINT * wavenumber**2 * float(np.nanmin(ground.wave_speeds(axis))) ** 2
    stiffness = ways.conj().T @ diags(network.springs) @ ways + faint * diags(mass)
    phases = np.exp(1j * brick.positions @ (_coupled(axis, number, brick.size) - k).T)
    waves = np.zeros((3, *phases.shape, 2), dtype=complex)  # component, disk, wave, direction of the translation
    waves[0, :, :, 0] = waves[1, :, :, 1] = phases
    waves = waves.reshape(len(mass), -1)
    pushed = mass[:, None] * waves
    solver = splu(stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    flexibility = pushed.conj().T @ solver.solve(pushed)
    squares, shapes = np.linalg.eigh(waves.conj().T @ pushed)
    root = (shapes * np.sqrt(squares)) @ shapes.conj().T
    matrix = root @ np.linalg.solve(flexibility, root)
    omega2, polarisations = np.linalg.eigh(matrix[:2, :2])
    slower = polarisations[:, 0]
    shared = float(abs(slower.conj() @ matrix[:2, 2:4] @ slower))
    return Coupling(wavenumber, math.sqrt(omega2[0]) / (2.0 * math.pi), wavenumber * shared / (2.0 * float(omega2[0])))


def _coupled(axis: int, number: int, size: np.ndarray) -> np.ndarray:
    """Wave vectors (w, 2) rad/m, not longer than k, that copies couple to k; the first is k, the second −k."""
    k = number * math.pi / size[axis] * np.eye(2)[axis]
    most = number * np.where(np.arange(2) == axis, 1.0, np.ceil(0.5 * size / size[axis])).astype(int)
    counts = np.mgrid[-most[0] : most[0] + 1, -most[1] : most[1] + 1].reshape(2, -1).T
    waves = k + 2.0 * math.pi * counts / size
    waves = waves[np.hypot(*waves.T) <= math.hypot(*k) * (1.0 + ROUNDING)]
    others = np.abs(waves @ k) < (1.0 - ROUNDING) * float(k @ k)
    return np.concatenate([[k, -k], waves[others]])


def sent_back(
    ground: PackedMaterial, signals: Sequence[Signal], lengths: Sequence[float], axes: Sequence[int]
) -> float:
    """Energy of velocities reflected by copies, RMS over RMS, of the signal with the largest.

    lengths : of the ground along x and y, m. axes : along which waves run; the mean over them is returned.
    """
    shares = np.zeros(len(signals))
    cutoff = max(sizing.cutoff(signal, LEFT_OUT) for signal in signals)
    for axis in axes:
        lowest = float(np.nanmin(ground.wave_speeds(axis))) / (2.0 * float(ground.brick.size[axis]))
        for number in range(1, math.floor(cutoff / lowest) + 1):
            found = coupling(ground, axis, number)
            shares += [found.band(lengths[axis]) * _density(signal, found.frequency) / len(axes) for signal in signals]
    return math.sqrt(min(float(shares.max()), 1.0))


def _density(signal: Signal, frequency: float) -> float:
    """Share of the energy of velocities per frequency (1/Hz) at a frequency."""
    frequencies, energy = sizing.energies(signal)
    step = frequencies[1] - frequencies[0]
    return float(np.interp(frequency, frequencies, energy) / (energy.sum() * step))

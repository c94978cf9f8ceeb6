"""Waves of a packing: the coupling of opposite ones by copies of a brick, and the fastest."""

import math

import numpy as np
import pytest
from scipy.linalg import eigh

from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import (
    Coupling,
    couplings,
    front_of,
    largest_group_speed,
    largest_phase_speed,
    slowest_speed,
)
from dembound.disks.scene import ground_of


@pytest.mark.parametrize("axis", [0, 1])
def test_all_numbers_are_coupled_as_each_by_itself(dense: PackedMaterial, axis: int) -> None:
    """ω² a = N F⁻¹ N a, with the complex phases of each number; what is held faintly changes some 1e-6."""
    brick, network = dense.brick, Network.of_brick(dense.brick, dense.stiffness)
    mass = np.concatenate([dense.mass, dense.mass, dense.inertia])
    for along, found in couplings(dense, {0: 3, 1: 4}):
        if along != axis:
            continue
        k = found.wavenumber * np.eye(2)[axis]
        ways = network.motion_matrix(np.exp(1j * network.vectors @ k)).toarray()
        stiffness = ways.conj().T @ (network.springs[:, None] * ways)
        counts = np.mgrid[-9:10, -9:10].reshape(2, -1).T
        waves = k + 2.0 * np.pi * counts / brick.size
        waves = waves[np.hypot(*waves.T) < found.wavenumber * (1.0 + 1e-9)]
        waves = waves[np.argsort(np.abs(waves - k).sum(axis=1))]  # k itself is the first, −k the one with the least dot
        opposite = int(np.argmin(waves @ k))
        phases = np.exp(1j * brick.positions @ (waves - k).T)
        moved = np.concatenate([np.kron(phases, row) for row in np.eye(3, 2)])
        pushed = mass[:, None] * moved
        faint = 1e-9 * found.wavenumber**2 * float(dense.wave_speeds(axis)[0]) ** 2
        flexibility = pushed.conj().T @ np.linalg.solve(stiffness + faint * np.diag(mass), pushed)
        masses = moved.conj().T @ pushed
        whole = masses @ np.linalg.solve(flexibility, masses)
        both = [0, 1, 2 * opposite, 2 * opposite + 1]
        lower, upper = np.sqrt(eigh(whole[np.ix_(both, both)], masses[np.ix_(both, both)], eigvals_only=True)[:2])
        assert 2.0 * math.pi * found.frequency == pytest.approx(math.sqrt(0.5 * (lower**2 + upper**2)), rel=1e-3)
        assert 2.0 * found.per_length / found.wavenumber == pytest.approx(
            (upper**2 - lower**2) / (upper**2 + lower**2), rel=0.02
        )


def test_a_band_has_the_energy_that_coupled_waves_send_back() -> None:
    """|r|² = κ² sinh²(sl)/(s² cosh²(sl) + δ² sinh²(sl)), s² = κ² − δ², δ = 2π(f − f0)/c.

    The sum ends at δ = 2/m, beyond which 1/2πl of it is, 0.3 % for 50 m.
    """
    found = Coupling(wavenumber=0.2, frequency=30.0, per_length=0.004)
    detuning = (np.arange(-200_000, 200_000) + 0.5) * 1e-5
    for length in (50.0, 500.0):
        s = np.sqrt((found.per_length**2 - detuning**2).astype(complex))
        ratio = found.per_length * np.sinh(s * length) / (s * np.cosh(s * length) + 1j * detuning * np.sinh(s * length))
        speed = 2.0 * math.pi * 30.0 / 0.2
        band = float(np.sum(np.abs(ratio) ** 2)) * 1e-5 * speed / (2.0 * math.pi)
        assert found.band(length) == pytest.approx(band, rel=5e-3)


SOFT = {"fric": 0.5, "kratio": 0.5, "pb_kratio": 0.5}
"""Shear twice as stiff as normal."""


@pytest.fixture
def ground(bar):
    def make(held=(), **material):
        keys = {f"material.{key}": value for key, value in material.items()}
        return ground_of(bar(keys | {"motion.held": list(held), "boundary": {}}))

    return make


def test_phase_speeds_are_the_largest_of_all_directions(ground) -> None:
    # k_s = 2 k_n, free rotations: C11 = K, C66 = k_s/2 = K, C12 = 0. Along an axis both waves run at 1000 m/s; along
    # the diagonal P waves have (C11 + C66)/2 + (C12 + C66)/2 = 1.5 K
    assert largest_phase_speed(ground(**SOFT)) == pytest.approx(1000.0 * np.sqrt(1.5), rel=1e-12)
    # isotropic: k_s = k_n
    assert largest_phase_speed(ground(fric=0.5)) == pytest.approx(1000.0, rel=1e-12)
    assert largest_phase_speed(ground(held=["x"])) == pytest.approx(1000.0, rel=1e-12)
    assert largest_phase_speed(ground(held=["x", "y"])) == 0.0
    assert front_of(ground(held=["x", "y"]), 0.9).speed == 0.0
    # without friction k_s = k_n/2 with free rotations: c_s = c_p/2
    assert slowest_speed(ground()) == pytest.approx(500.0, rel=1e-12)


def test_group_speeds_are_slopes_of_the_frequency(ground) -> None:
    """With x and y held only rotations are left, whose frequency has a closed form.

    Contacts along an axis bend by 2i sin(q/2)·θ and shear by −2R cos(q/2)·θ, so that Iω² is the sum over both axes of
    4k_b sin²(q/2) + 4k_sR² cos²(q/2). Its slope is largest somewhere inside the zone; it is searched on a grid four
    times as fine, which the grid of the code misses by (π/48)²/2 = 0.2 % at most.
    """
    lattice = ground(held=["x", "y"], pb_rmul=3.0)
    radius, (shear, *_), (bend, *_) = 0.25, lattice.stiffness.shear, lattice.stiffness.bending
    q = np.linspace(-np.pi, np.pi, 400)
    square = sum(
        4.0 * bend * np.sin(0.5 * each) ** 2 + 4.0 * shear * radius**2 * np.cos(0.5 * each) ** 2
        for each in np.meshgrid(q, q)
    )
    frequency = np.sqrt(square / lattice.inertia[0])
    slopes = np.hypot(*np.gradient(frequency, q, q)) * 2.0 * radius

    def central(safety):
        stepped = 2.0 * np.arcsin(safety * frequency / frequency.max())
        return (np.hypot(*np.gradient(stepped, q, q)) * 2.0 * radius).max() * frequency.max() / (2.0 * safety)

    assert largest_group_speed(lattice, 1e-6) == pytest.approx(slopes.max(), rel=4e-3)
    assert largest_group_speed(lattice, 0.9) == pytest.approx(central(0.9), rel=8e-3)
    assert central(0.9) > 1.05 * slopes.max()

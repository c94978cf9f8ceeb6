"""The fastest waves of a packing."""

import numpy as np
import pytest

from dembound.disks.material.packing_waves import (
    front_of,
    largest_group_speed,
    largest_phase_speed,
    slowest_speed,
)
from dembound.disks.scene import ground_of

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

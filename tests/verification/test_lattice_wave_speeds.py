"""Wave speeds of the square lattice, from the real force kernel on periodic plane waves."""

import numpy as np
import pytest

ROW = 200
"""Disks per wavelength. All couplings of the lattice are even in qa, so speeds differ from those of long waves by
O((qa)²); its coefficients are 1/24 of the dispersion, 1/64 of the rotational inertia, 1/48 of the bonds' bending and
1/8 of the averaged rotations θ_i + θ_j, all below 1/8 in size and 1/4 in sum."""
LONG_WAVE = 0.25 * (2.0 * np.pi / ROW) ** 2

ISOTROPIC = {"fric": 0.5}  # contacts carry shear too: k_s = k_n
BONDS_ONLY = {"fric": 0.0}  # only bonds do, half of the stiffness: k_s = k_n/2

PERIODIC = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")


def speeds(lab, scene, along, wavelength):
    """Phase speeds of the modes of a plane wave along a unit vector, the two slow ones, falling.

    In a lattice of one disk per cell a plane wave stays one: K(q) of its three amplitudes comes from the forces on
    the disk at the origin under cosine and sine waves.
    """
    q = 2.0 * np.pi / wavelength
    phase = q * (scene.assembly.positions - scene.assembly.positions[0]) @ along
    stiffness = np.empty((3, 3), dtype=complex)
    for component in range(3):
        for part, wave in ((1.0, np.cos(phase)), (1j, np.sin(phase))):
            u = np.zeros((3, scene.count))
            u[component] = wave
            force = lab.forces(scene, u)[:, 0]
            stiffness[:, component] = (0.0 if part == 1.0 else stiffness[:, component]) - part * force
    moving = np.flatnonzero(scene.free)
    root = 1.0 / np.sqrt(np.array([scene.mass[0], scene.mass[0], scene.inertia[0]]))[moving]
    squares = np.linalg.eigvalsh(root[:, None] * stiffness[np.ix_(moving, moving)] * root)
    return np.sqrt(squares[:2][::-1]) / q


@pytest.mark.parametrize(("material", "s_over_p"), [(ISOTROPIC, 0.5**0.5), (BONDS_ONLY, 0.5)])
def test_on_axis_with_free_rotation(lab, material, s_over_p):
    """C11 = k_n and C44 = k_s/2: half of the shear is turned away by the rotation."""
    scene = lab.scene("A", (ROW * lab.diameter, lab.diameter), held=(), material=material, boundary=PERIODIC)
    expected = np.array([lab.speed, s_over_p * lab.speed])
    measured = speeds(lab, scene, np.array([1.0, 0.0]), ROW * lab.diameter)
    np.testing.assert_allclose(measured, expected, rtol=LONG_WAVE)
    np.testing.assert_allclose(scene.ground.wave_speeds(0), expected, rtol=1e-12)  # closed form on both sides


@pytest.mark.parametrize(("material", "p_square", "s_square"), [(ISOTROPIC, 1.0, 0.5), (BONDS_ONLY, 0.75, 0.5)])
def test_along_the_diagonal(lab, material, p_square, s_square):
    """ρc_p² = (C11 + C12 + 2C44)/2 and ρc_s² = (C11 − C12)/2: as on axis only when k_n = k_s."""
    scene = lab.scene("A", (ROW * lab.diameter, ROW * lab.diameter), held=(), material=material, boundary=PERIODIC)
    along = np.array([1.0, 1.0]) / np.sqrt(2.0)
    measured = speeds(lab, scene, along, ROW * lab.diameter / np.sqrt(2.0))
    expected = lab.speed * np.sqrt([p_square, s_square])
    np.testing.assert_allclose(measured, expected, rtol=2.0 * LONG_WAVE)  # (qa)² is twice as large
    tensor = scene.ground.tensor / (lab.density * lab.speed**2)
    from_tensor = [0.5 * (tensor[0, 0] + tensor[0, 1] + 2.0 * tensor[3, 3]), 0.5 * (tensor[0, 0] - tensor[0, 1])]
    np.testing.assert_allclose(from_tensor, [p_square, s_square], rtol=1e-12)

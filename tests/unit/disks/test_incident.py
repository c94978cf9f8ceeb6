"""Waves that enter from a continuum below: the plane waves, and the forces by which ties pass them on."""

from types import SimpleNamespace

import numpy as np
import pytest

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks.material import Material
from dembound.disks.cut_bonds import CutBonds
from dembound.disks.incident import IncidentForces, PlaneWaves
from dembound.disks.packed_material import PackedMaterial, make_packed_material
from dembound.disks.surroundings import medium_of
from dembound.disks.wall import Wall
from dembound.kernels.wall import tie_forces
from dembound.outside.medium import Medium
from dembound.outside.mesh import Around, Mesh
from dembound.packings.cut import cut_contacts
from dembound.packings.dense import Recipe, pack_dense
from dembound.packings.square import Square
from dembound.packings.tiling import tile

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0, fric=0.5)
OBLIQUE = Medium(2500.0, c11=2.5e9, c22=2.2e9, c12=0.4e9, c66=0.9e9, c16=0.2e9, c26=0.3e9)


def sine(frequency: float) -> SimpleNamespace:
    """A wave sin(ωt) m/s."""
    omega = 2.0 * np.pi * frequency
    return SimpleNamespace(velocity=lambda t: np.sin(omega * t), displacement=lambda t: -np.cos(omega * t) / omega)


RAMP = SimpleNamespace(velocity=lambda t: np.ones_like(t), displacement=lambda t: np.array(t))
"""A velocity of 1 m/s for ever, a uniform gradient."""


def motion(waves: PlaneWaves, y: float, times: np.ndarray, of: str = "displacement") -> np.ndarray:
    """u_x and u_y (k, 2) of the wave at a height."""
    return waves.amplitudes(times, of) @ waves.motion(np.array([y]), np.zeros((3, 4, 1)))[:2, 0].T


def test_velocities_are_the_given_ones_on_the_line() -> None:
    waves = PlaneWaves(OBLIQUE, 3.0, (sine(4.0), sine(7.0)), (2.0, 5.0))
    times = np.linspace(0.0, 0.3, 50)
    given = np.stack([wave.velocity(times) for wave in waves.waves], axis=1)
    # of the polynomial through five points on 3 m, a tenth of a wavelength: some 1e-6
    np.testing.assert_allclose(motion(waves, 3.0, times, "velocity"), given, atol=1e-5)


def test_they_obey_the_equation_of_motion_and_run_upwards() -> None:
    """ρü = C u″ with C = [[c66, c26], [c26, c22]], and stress −Σ ρc_m v_m against the direction of travel."""
    waves = PlaneWaves(OBLIQUE, 0.0, (sine(4.0), sine(7.0)), (-1.5, 1.5))
    times, h = np.array([0.02, 0.05]), 0.3
    near = [motion(waves, y, times) for y in (-h, 0.0, h)]
    later = [motion(waves, 0.0, times + dt) for dt in (-1e-4, 0.0, 1e-4)]
    tensor = np.array([[0.9e9, 0.3e9], [0.3e9, 2.2e9]])
    bent = (near[0] - 2.0 * near[1] + near[2]) / h**2 @ tensor
    faster = 2500.0 * (later[0] - 2.0 * later[1] + later[2]) / 1e-8
    np.testing.assert_allclose(bent, faster, atol=2e-3 * np.abs(faster).max())
    stress = (near[2] - near[0]) / (2.0 * h) @ tensor
    brought = -np.sum(stress * motion(waves, 0.0, times, "velocity"), axis=1)
    np.testing.assert_allclose(brought, waves.power(times), rtol=2e-3)


def dense() -> PackedMaterial:
    brick = pack_dense(Recipe(size=(6.0, 6.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))
    return make_packed_material(brick, MATERIAL, ())


def square() -> PackedMaterial:
    return make_packed_material(Square(size=(6.0, 6.0), radius=0.25).pack(1.25e9), MATERIAL, ())


@pytest.mark.parametrize("ground", [dense, square])
@pytest.mark.parametrize("mean", [False, True])
def test_an_undisturbed_packing_leaves_the_continuum_at_rest(ground, mean) -> None:
    """Drives and ties cancel on its nodes if the disks have the incident motion; on these they leave the bonds' force.

    In the velocity of 1 m/s gradients are uniform, and so the forces of the bonds exact.
    """
    ground = ground()
    copies = tuple(np.rint(6.0 / ground.brick.size).astype(int))
    body = tile(ground.brick, copies, (True, False))
    mesh = Mesh.around(
        (0.0, 0.0, 6.0, 6.0), (6.0, 6.0), margin=Around(bottom=1), layer=Around(), periodic=(True, False)
    )
    cut = cut_contacts(ground.brick, body, ("bottom",), (True, False))
    lag = 2e-4
    wall = Wall.of(mesh, CutBonds.of(ground, cut, body.positions).between(mesh.sides), lag, (mean, False))
    medium = medium_of(ground)
    incident = IncidentForces.of(wall, medium, 0.0, (RAMP, RAMP))
    disks = len(body.radii)
    builder = SupportBuilder()
    incident.add_to_disks(builder, incident.disk)
    incident.add_to_nodes(builder, disks + incident.node)
    table = builder.table()
    drives = np.zeros((disks + mesh.count, 3))
    drives[table.node, table.component] = table.sample(np.array([0.25]), 1e-4)[0]

    speeds, polarisations = medium.plane_waves((0.0, 1.0))
    parts = polarisations * (polarisations.T @ [1.0, 1.0])  # velocities of both waves
    own = ground.continuum.corrector[:, body.brick_particle][:, :, [2, 1]]
    u, v = np.zeros((2, 3, disks + mesh.count))
    gradient = -(parts / speeds).sum(axis=1)
    for component in range(3):
        u[component, :disks] = own[:, :][component] @ gradient
    u[:2, :disks] += 0.25 * parts.sum(axis=1)[:, None] + gradient[:, None] * body.positions[:, 1]
    v[:2, :disks] = parts.sum(axis=1)[:, None]
    every = np.arange(disks + mesh.count)
    ties = np.zeros((disks + mesh.count, 3))
    tie_forces(wall.ties(every[:disks], every[disks:], every, None), u, v, ties, lag)

    size = np.abs(ties).max()
    np.testing.assert_allclose((drives + ties)[disks:, :2], 0.0, atol=1e-11 * size)
    stress = np.array([[medium.c66, medium.c26], [medium.c26, medium.c22]]) @ gradient
    np.testing.assert_allclose((drives + ties)[:disks, :2].sum(axis=0), -6.0 * stress, rtol=1e-9)
    assert np.abs(drives[disks:, :2]).max() > 0.1 * size

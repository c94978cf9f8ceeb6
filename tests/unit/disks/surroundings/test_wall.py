"""Ties of cut bonds to a continuum: exact under every uniform gradient, and in balance."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.continuum.mesh import Mesh
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.wall import Wall, lag_of
from dembound.kernels.tables import WallTies
from dembound.kernels.wall import tie_forces, wall_forces
from dembound.packings.cut import cut_contacts
from dembound.packings.dense import Recipe, pack_dense
from dembound.packings.square import Square
from dembound.packings.tiling import Assembly, tile

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0, fric=0.5)
SIDES = ("left", "right", "bottom", "top")


def dense() -> PackedMaterial:
    brick = pack_dense(Recipe(size=(6.0, 6.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))
    return make_packed_material(brick, MATERIAL, ())


def square() -> PackedMaterial:
    return make_packed_material(Square(size=(1.0, 1.0), radius=0.25).pack(1.25e9), MATERIAL, ())


@pytest.fixture(scope="module", params=[dense, square])
def ground(request) -> PackedMaterial:
    return request.param()


class Tied:
    """A body of 12 m × 12 m in a mesh of elements of several widths and heights, its particles first."""

    def __init__(self, ground: PackedMaterial) -> None:
        self.ground = ground
        self.body: Assembly = tile(ground.brick, tuple(np.rint(12.0 / ground.brick.size).astype(int)), (False, False))
        self.mesh = Mesh(
            order=4, widths=(4.0, 5.0, 7.0, 6.0), heights=(5.0, 6.5, 5.5, 3.0), origin=(-4.0, -5.0), box=(1, 1, 3, 3)
        )
        self.cut = cut_contacts(ground.brick, self.body, SIDES)
        self.wall = Wall.of(self.mesh, CutBonds.of(ground, self.cut, self.body.positions), 0.0)
        self.particles, self.count = len(self.body.radii), len(self.body.radii) + self.mesh.count

    def ties(self, twin: np.ndarray | None = None, line: np.ndarray | None = None) -> WallTies:
        every = np.arange(self.count)
        return self.wall.ties(
            every[: self.particles],
            every[self.particles :],
            every if line is None else line,
            None if twin is None else twin[self.wall.bonds.particle],
        )

    def strained(self, gradient: np.ndarray) -> np.ndarray:
        """Displacements (3, n) of particles and nodes under a mean gradient (4,) xx, yy, xy, yx."""
        matrix = np.array([[gradient[0], gradient[2]], [gradient[3], gradient[1]]])
        u = np.zeros((3, self.count))
        u[:2] = matrix @ np.vstack([self.body.positions, self.mesh.positions]).T
        u[:, : self.particles] += self.ground.continuum.corrector[:, self.body.brick_particle] @ gradient
        return u

    def forces(self, u: np.ndarray) -> np.ndarray:
        force = np.zeros((self.count, 3))
        tie_forces(self.ties(), u, np.zeros_like(u), force, 0.0)
        return force


def test_a_uniform_gradient_leaves_every_particle_in_equilibrium(ground) -> None:
    """Equilibrium as in the infinite tiling, whose bonds the ties replace."""
    tied = Tied(ground)
    network = Network.of_assembly(ground.brick, ground.stiffness, tied.body)
    motions = network.motion_matrix()
    assert len(tied.cut.node) > 60
    for gradient in np.eye(4):
        u = tied.strained(gradient)
        inside = -(motions.T @ (network.springs * (motions @ u[:, : tied.particles].ravel()))).reshape(3, -1).T
        of_ties = tied.forces(u)[: tied.particles]

        size = np.abs(of_ties).max()
        assert size > 0.05 * ground.stiffness.normal.mean() * ground.brick.mean_diameter
        # the error of the sparse solve for the correctors: rounding times a condition number below 1e6
        np.testing.assert_allclose(inside + of_ties, 0.0, atol=1e-10 * size)


def test_ties_neither_push_nor_turn_the_whole(ground) -> None:
    """The sum of forces, and of moments about the origin, of particles and nodes is zero in any motion."""
    tied = Tied(ground)
    u = np.random.default_rng(4).normal(size=(3, tied.count))
    force = tied.forces(u)
    x, y = np.vstack([tied.body.positions, tied.mesh.positions]).T
    size = np.abs(force).sum()

    np.testing.assert_allclose(force[:, :2].sum(axis=0), 0.0, atol=1e-13 * size)
    # a rigid rotation strains no tie, so no moment acts: the correctors contain the rotation of the disks
    turned = np.stack([-y, x, np.ones_like(x)])
    assert abs(np.sum(turned * force.T)) <= 1e-9 * 12.0 * size
    assert np.abs(tied.forces(turned)).max() <= 1e-9 * np.abs(force).max()


def test_a_twin_leaves_what_the_particle_has_beyond_it_and_velocities_count_times_the_lag(ground) -> None:
    """Forces are added to existing ones, at the lines of the support table; none act on the twins."""
    tied, rng = Tied(ground), np.random.default_rng(5)
    u, v, before = rng.normal(size=(3, 3, tied.count))
    twin, line = np.roll(np.arange(tied.particles), 7), rng.permutation(tied.count)
    tied.wall = replace(tied.wall, lag=0.3)
    force = before.T.copy()
    wall_forces(tied.ties(twin, line), u, v, force)
    relative = u + 0.3 * v
    relative[:, : tied.particles] -= relative[:, twin]
    expected = tied.forces(relative)

    np.testing.assert_allclose((force - before.T)[line], expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())


def test_the_dashpot_of_a_lattice_is_a_share_of_its_impedance() -> None:
    made = square()
    # half bonds of 2K with K = ρc_p²: η·2K = 0.3 ρc_pD
    assert lag_of(made, 0.3) * 2.0 * made.stiffness.normal[0] == pytest.approx(0.3 * 2500.0 * 1000.0 * 0.5)


def test_ties_half_way_to_other_sides_turn_nothing_and_move_by_half_of_it(ground) -> None:
    """Sides moved by 2 m move the motion of ties by 1 m along the gradients of each component."""
    tied = Tied(ground)
    bonds = CutBonds.of(ground, tied.cut, tied.body.positions)
    near, far = (bonds.between(np.add(tied.mesh.sides, [-offset, offset, -offset, offset])) for offset in (0.0, 2.0))
    moved = far.corrector - near.corrector
    for number, (axis, sign) in enumerate(((0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0))):
        of_side = moved[..., bonds.side == number]
        expected = np.zeros((3, 4))
        expected[axis, axis] = sign  # xx or yy
        expected[1 - axis, 2:] = sign  # xy and yx
        np.testing.assert_allclose(of_side, np.broadcast_to(expected[..., None], of_side.shape), atol=1e-12)
    tied.wall = Wall.of(tied.mesh, far, 0.0)
    x, y = np.vstack([tied.body.positions, tied.mesh.positions]).T
    u = np.random.default_rng(4).normal(size=(3, tied.count))
    turned = np.stack([-y, x, np.ones_like(x)])
    assert np.abs(tied.forces(turned)).max() <= 1e-9 * np.abs(tied.forces(12.0 * u)).max()

"""The forces by which plane waves of the ground enter a body, and which waves are refused."""

import numpy as np
import pytest
from ground_motions import GENERAL, RAMP, ground, sine
from small_cases import SURROUNDED, small

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks.material import Material
from dembound.disks.beyond.cut_bonds import CutBonds
from dembound.disks.beyond.ground_waves import GroundWaves, rising_waves
from dembound.disks.beyond.incident import SummedDrives, let_in, parts_of, power_through
from dembound.disks.beyond.surroundings import medium_of
from dembound.disks.beyond.wall import Wall
from dembound.disks.material.packed_material import PackedMaterial, make_packed_material
from dembound.disks.scene import build
from dembound.disks.stability import fill_forces
from dembound.errors import CaseError
from dembound.kernels.wall import tie_forces
from dembound.outside.mesh import Around, Mesh
from dembound.packings.cut import cut_contacts
from dembound.packings.dense import Recipe, pack_dense
from dembound.packings.square import Square
from dembound.packings.tiling import tile

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0, fric=0.5)
INCIDENT = {"type": "sv", "angle": 20.0, "wave": "pulse"}
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
BELOW = SURROUNDED | {"incident": INCIDENT, "wave": {"pulse": PULSE}}
RANDOM = {
    "pattern": "B",
    "size": [12.0, 6.0],
    "radius": 0.5,
    "radius_ratio": 1.5,
    "brick": [6.0, 6.0],
}


def random() -> PackedMaterial:
    brick = pack_dense(Recipe(size=(6.0, 6.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))
    return make_packed_material(brick, MATERIAL, ())


def lattice() -> PackedMaterial:
    return make_packed_material(Square(size=(6.0, 6.0), radius=0.25).pack(1.25e9), MATERIAL, ())


@pytest.mark.parametrize("packing", [random, lattice])
@pytest.mark.parametrize("mean", [False, True])
def test_under_rising_waves_an_undisturbed_packing_leaves_the_continuum_at_rest(packing, mean) -> None:
    """Drives and ties cancel on its nodes if the disks have the incident motion; on these they leave the bonds' force.

    In the velocity of 1 m/s gradients are uniform, and so the forces of the bonds exact.
    """
    packed = packing()
    copies = tuple(np.rint(6.0 / packed.brick.size).astype(int))
    body = tile(packed.brick, copies, (True, False))
    mesh = Mesh.around(
        (0.0, 0.0, 6.0, 6.0), (6.0, 6.0), margin=Around(bottom=1), layer=Around(), periodic=(True, False)
    )
    cut = cut_contacts(packed.brick, body, ("bottom",), (True, False))
    lag = 2e-4
    wall = Wall.of(mesh, CutBonds.of(packed, cut, body.positions).between(mesh.sides), lag, (mean, False))
    medium = medium_of(packed)
    disks = len(body.radii)
    waves = rising_waves(medium, 0.0, (RAMP, RAMP), packed.brick.mean_diameter)
    entering = SummedDrives(list(parts_of(wall, waves, body.positions, disks)))
    drives = np.zeros((disks + mesh.count, 3))
    drives[entering.node, entering.component] = entering(np.array([0.25]), 1e-4)[0]

    speeds, polarisations = medium.plane_waves((0.0, 1.0))
    parts = polarisations * (polarisations.T @ [1.0, 1.0])  # velocities of both waves
    own = packed.continuum.corrector[:, body.brick_particle][:, :, [2, 1]]
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


@pytest.mark.parametrize("packing", [{}, {"packing": RANDOM, "outside": {"element": 6.0, "order": 3, "layers": 2}}])
def test_under_a_wave_at_an_angle_an_undisturbed_packing_leaves_the_continuum_at_rest(packing) -> None:
    """Drives and ties cancel on its nodes if the disks move as undisturbed; on the disks they leave the bonds' forces.

    Under uniform gradients these are in equilibrium with those of the body's own bonds.
    """
    scene = build(small(BELOW | packing, changes={"boundary.top": {"type": "outside"}}))
    outside, waves = scene.outside, scene.ground_waves
    waves = GroundWaves(waves.medium, waves.waves, (RAMP,) * len(waves.waves), waves.grain)
    builder = SupportBuilder()
    let_in(outside, waves, scene.positions, builder)
    table, half_step = builder.table(), 1e-4
    drives = np.zeros((scene.count, 3))
    at = 0.25
    forces = ~np.isin(table.drive_signal, list(table.shares.power.values()))
    signals = table.sampled(np.array([at]), half_step)[0]
    np.add.at(
        drives,
        (table.node[table.drive_row[forces]], table.component[table.drive_row[forces]]),
        (signals[table.drive_signal] * table.drive)[forces],
    )
    disks = scene.disk_count
    corrector = np.moveaxis(scene.ground.continuum.corrector[:, scene.assembly.brick_particle], 1, 2)
    u, v = np.zeros((2, 3, scene.count))
    u[:, :disks] = waves.motion("displacement", np.array([at]), scene.positions[:disks], corrector)[0].T
    v[:, :disks] = waves.motion("velocity", np.array([at]), scene.positions[:disks], corrector)[0].T
    every = np.arange(scene.count)
    ties = np.zeros((scene.count, 3))
    wall = outside.wall
    tie_forces(wall.ties(every[:disks], every[outside.nodes], every, None), u, v, ties, wall.lag)

    np.testing.assert_allclose((drives + ties)[disks:, :2], 0.0, atol=1e-9 * np.abs(ties).max())
    own = np.zeros_like(scene.layout.spread(u))
    fill_forces(scene, scene.layout.spread(u), own)  # of the bonds within the body
    within = scene.layout.gather(own)[:, :disks].T
    np.testing.assert_allclose(within + (drives + ties)[:disks], 0.0, atol=1e-8 * np.abs(within).max())


def test_the_power_through_a_side_is_that_of_the_waves_that_run_inwards() -> None:
    """Through the left side all three, as all run to the right; of a sine ½ F per m² in the mean; none on the right."""
    waves = ground(sine(20.0))
    edges, times = (-3.0, 5.0, 2.0, 12.0), np.linspace(0.0, 1.0, 4001)[:-1]
    along = sum(wave.flux(GENERAL)[0] for wave in waves.waves)

    assert power_through("left", edges, waves)(times).mean() == pytest.approx(0.5 * 10.0 * along, rel=1e-6)
    assert not power_through("right", edges, waves)(times).any()
    up = waves.waves[0].flux(GENERAL)[1]
    assert power_through("bottom", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)
    assert power_through("top", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)

    # a mass on the surface sends back as much; its delay is of the first order in ωm/ρc = 0.006, energies of the second
    heavy = ground(sine(20.0), mass=0.05 * GENERAL.density)
    for side, expected in (("left", 10.0 * along), ("top", 8.0 * up)):
        assert power_through(side, edges, heavy)(times).mean() == pytest.approx(0.5 * expected, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"incident.angle": 45.0}, r"incident\.angle: is 45; from the critical angle of this packing on, 45 degrees"),
        ({"incident.angle": -60.0}, r"incident\.angle: is -60; .* -45 degrees, .* must be above that"),
        ({"incident.point": [30.0, 30.0]}, r"incident\.point: .* give wave\.pulse\.start = 0\.05"),
    ],
)
def test_what_a_scene_refuses(changes, problem: str) -> None:
    with pytest.raises(CaseError, match=problem):
        build(small(BELOW, changes=changes))


def test_without_a_surface_there_is_no_critical_angle() -> None:
    scene = build(small(BELOW, changes={"boundary.top": {"type": "outside"}, "incident.angle": 60.0}))

    assert len(scene.ground_waves.waves) == 1


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"incident.wave": "puls"}, 'incident.wave: "puls" is not a wave of this case; defined: pulse'),
        ({"boundary.left": {"type": "viscous"}}, 'boundary.left.type: is "viscous", but the wave of [incident]'),
        ({"boundary.top": {"type": "fixed"}}, 'boundary.top.type: is "fixed", but the wave of [incident]'),
        ({"boundary.bottom.wave_s": "pulse"}, "boundary.bottom.wave_s: is not allowed together with [incident]"),
        ({"incident.angle": 90.0}, "incident.angle: is 90"),
        ({"incident.type": "sh"}, "incident.type: "),
    ],
)
def test_what_a_case_refuses(changes, problem: str) -> None:
    with pytest.raises(CaseError) as error:
        small(BELOW, changes=changes)
    assert problem in str(error.value)

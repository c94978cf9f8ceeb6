"""The motion of ground under a wave at an angle near ties, the forces by which it enters, and what is refused."""

from types import SimpleNamespace

import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.boundaries.support import SupportBuilder
from dembound.disks.ground_waves import GroundWaves
from dembound.disks.oblique import let_in, power_through
from dembound.disks.scene import build
from dembound.disks.stability import fill_forces
from dembound.errors import CaseError
from dembound.kernels.wall import tie_forces
from dembound.outside.medium import Medium
from dembound.outside.plane_waves import incident_wave, reflected_waves

GENERAL = Medium(2500.0, c11=2.5e9, c22=2.2e9, c12=0.4e9, c66=0.9e9, c16=0.2e9, c26=0.3e9)
RAMP = SimpleNamespace(velocity=lambda t: np.ones_like(t), displacement=lambda t: np.array(t))
"""A velocity of 1 m/s for ever: uniform gradients."""


def sine(frequency: float) -> SimpleNamespace:
    """A wave sin(ωt) m/s."""
    omega = 2.0 * np.pi * frequency
    return SimpleNamespace(velocity=lambda t: np.sin(omega * t), displacement=lambda t: -np.cos(omega * t) / omega)


def ground(signal, grain: float = 0.1, mass: float = 0.0) -> GroundWaves:
    incident = incident_wave(GENERAL, "sv", 25.0)
    return GroundWaves(GENERAL, (incident, *reflected_waves(GENERAL, incident, 30.0, mass)), signal, grain)


def test_near_places_the_motion_is_that_of_the_waves() -> None:
    """Places within 8 m, half of the shortest wave: 1e-5 by the estimate of `DELAYS`; correctors as by differences."""
    waves = ground(sine(40.0), 1e-3)
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform(0.0, 8.0, (20, 2)) * [1.0, 0.1], rng.normal(size=(3, 4, 20))
    near, times = waves.near(places), np.array([0.31, 0.35, 0.4])
    exact = waves.motion("displacement", times, places, corrector)
    found = np.einsum("tq,cdq->tdc", near.amplitudes(times), near.motion(places, corrector))

    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
    moving = waves.motion("velocity", times, places)
    behind = near.amplitudes(times + 1e-4) @ near.velocities(1e-4).T
    found = np.einsum("tq,cdq->tdc", behind, near.motion(places, np.zeros((3, 4, 20))))
    np.testing.assert_allclose(found, moving, atol=1e-3 * np.abs(moving).max())


def test_the_packing_moves_beyond_its_mean_strain() -> None:
    """Under uniform gradients: u + χ : ∇u, with ∂u_a/∂b from differences of u itself, in the order xx, yy, xy, yx."""
    waves, corrector = ground(RAMP), np.random.default_rng(2).normal(size=(3, 4, 1))

    def u(x: float, y: float) -> np.ndarray:
        return waves.motion("displacement", np.array([1.0]), np.array([(x, y)]))[0, 0, :2]

    (xx, yx), (xy, yy) = u(3.0, 2.0) - u(2.0, 2.0), u(2.0, 3.0) - u(2.0, 2.0)
    moved = waves.motion("displacement", np.array([1.0]), np.array([(2.0, 2.0)]), corrector)[0, 0]
    expected = np.append(u(2.0, 2.0), 0.0) + corrector[:, :, 0] @ [xx, yy, xy, yx]
    np.testing.assert_allclose(moved, expected, rtol=1e-9)


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


@pytest.mark.parametrize("packing", [{}, {"packing": RANDOM, "outside": {"element": 6.0, "order": 3, "layers": 2}}])
def test_an_undisturbed_packing_leaves_the_continuum_at_rest(packing) -> None:
    """Drives and ties cancel on its nodes if the disks move as undisturbed; on the disks they leave the bonds' forces.

    Under uniform gradients these are in equilibrium with those of the body's own bonds.
    """
    scene = build(small(BELOW | packing, changes={"boundary.top": {"type": "outside"}}))
    outside, waves = scene.outside, scene.ground_waves
    waves = GroundWaves(waves.medium, waves.waves, RAMP, waves.grain)
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

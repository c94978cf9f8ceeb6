"""The thresholds of sides with a continuum beyond in docs/evidence/where_methods_fail.md, measured again."""

import numpy as np
import pytest
from angles import Side, branches, reflection
from decay import step_beside
from grid_scene import GridScene, step_limit

from dembound.continuum.axis import Around
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.motion.simulation import Simulation

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(("nodes", "part"), [(17.0, 2.2e-4), (8.0, 2.7e-3), (6.0, 1.6e-2), (4.0, 0.47)])
def test_coarse_elements_send_back_short_waves(nodes: float, part: float) -> None:
    """S waves at normal incidence, which layers without elements would take to 2e-6; elements are whole disks high."""
    side = Side.of(nodes)

    assert reflection(side, "s", 0.0)["s"] == pytest.approx(part, rel=0.15)
    assert side.formula("s", 0.0) < 3e-6


def test_two_layers_send_back_more_than_three() -> None:
    two, three = (reflection(Side.of(8.0, layers), "s", 0.0)["s"] for layers in (2, 3))

    assert two == pytest.approx(1.0e-2, rel=0.1)
    assert two > 3.0 * three


@pytest.mark.parametrize(("motion", "angle", "part"), [("p", 75.0, 0.050), ("s", 75.0, 0.032), ("p", 85.0, 0.37)])
def test_grazing_waves_come_back(motion: str, angle: float, part: float) -> None:
    assert reflection(Side.of(), motion, angle)[motion] == pytest.approx(part, rel=0.03)


def test_nodes_closer_than_disks_shorten_the_step() -> None:
    """1.25 diameters between the nodes, over 3; in random packings slopes of fine elements load the ties."""
    lattice, random = (step_beside(1.25, pattern) / step_beside(3.0, pattern) for pattern in "AB")

    assert lattice == pytest.approx(0.86, rel=0.03)
    assert random == pytest.approx(0.57, rel=0.03)


def test_rotations_of_disks_run_backwards() -> None:
    """The frequency falls with the wave number, so that energy runs against the phases.

    With k for both stiffnesses of a contact and I = mD²/8 all disks that turn together have ω² = 16 k/m. At λ = 2 D
    only contacts across slip, 8 k/m, and the bonds along, which have half of k, bend: 4/3 k/m.
    """
    turns = np.linspace(0.0, np.pi, 20)
    found = np.array([branches(turn)[2] for turn in turns])

    assert (np.diff(found) < 0.0).all()
    assert found[[0, -1]] == pytest.approx([4.0, np.sqrt(8.0 + 4.0 / 3.0)], rel=1e-9)
    assert (np.diff([branches(turn)[:2] for turn in turns], axis=0) > 0.0).all()


def noise_below(absorption: Absorption) -> list[float]:
    """Kinetic energies after 5,000 and 10,000 steps of noise in periodic ground of 24 m × 8 m, Poisson's ratio 0.25."""
    layers = {"margin": Around(bottom=1), "layer": Around(bottom=3), "periodic": (True, False)}
    mesh = Mesh.around((0.0, 0.0, 24.0, 8.0), (6.0, 4.0), 4, **layers)
    medium = Medium.isotropic(2500.0, 1000.0, 1000.0 / np.sqrt(3.0))
    return energies_of_noise(GridBody(mesh=mesh, medium=medium, absorption=absorption), (5000, 10_000))


def energies_of_noise(body: GridBody, after: tuple[int, ...]) -> list[float]:
    """Kinetic energies after some numbers of steps of noise in a continuum, of any unit."""
    simulation = Simulation(GridScene(body), 0.9 * step_limit(body))
    noise = np.zeros((3, body.count))
    noise[:2] = np.random.default_rng(0).standard_normal((2, body.count)) * ~body.mesh.held
    simulation.state.velocity = noise
    simulation.trackers.clear()  # a watch would stop what grows
    energies = []
    for steps in after:
        simulation.advance(steps - simulation.state.step)
        energies.append(float(np.sum(body.mass * simulation.state.velocity**2)))
    return energies


def test_layers_along_one_direction_amplify_noise() -> None:
    """Unless they also stretch derivatives along them."""
    earlier, later = noise_below(Absorption(along=0.0))
    assert later > 100.0 * earlier

    earlier, later = noise_below(Absorption())
    assert later < 0.5 * earlier


def noise_in_flat_ground(width: float) -> list[float]:
    """Kinetic energies after 15,000 and 25,000 steps of noise in 96 m × 8 m, ν = 0.25, with elements 4 m high."""
    mesh = Mesh.uniform(
        order=4, element=(width, 4.0), cells=(round(96.0 / width) + 8, 6), layer=Around(left=3, right=3, bottom=3)
    )
    body = GridBody(mesh=mesh, medium=Medium.isotropic(2500.0, 1000.0, 1000.0 / np.sqrt(3.0)))
    return energies_of_noise(body, (15_000, 25_000))


def test_layers_of_elements_longer_than_deep_amplify_noise_in_flat_ground() -> None:
    """Elements as wide as high do not."""
    earlier, later = noise_in_flat_ground(8.0)
    assert later > 100.0 * earlier

    earlier, later = noise_in_flat_ground(4.0)
    assert later < 2.0 * earlier

"""Dashpots of contacts: rebound, the step that they allow, what they take, and that debris comes to rest by them."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.stability import OPENING, step_limit, viscous_share
from dembound.motion import memory
from dembound.motion.simulation import Simulation

LOOSE = {"law": "linearpbond", "emod": 1e9, "pb_emod": 0.0, "fric": 0.5}
BONDED = {"law": "linearpbond", "fric": 0.5, "kratio": 2.0, "pb_kratio": 2.0}
BRITTLE = {"law": "linearpbond", "fric": 0.5, "pb_ten": 4e5, "pb_coh": 6e5}
RATIOS = {"dp_nratio": 0.2, "dp_sratio": 0.2}
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
STEPS = 250


def restitution(ratio: float) -> float:
    """Speed after over speed before the impact of two disks whose contact does not pull."""
    root = np.sqrt(1.0 - ratio**2)
    return float(np.exp(-ratio / root * (np.pi - np.arctan2(2.0 * ratio * root, 1.0 - 2.0 * ratio**2))))


@pytest.mark.parametrize(
    ("ratio", "expected"), [(0.1, 0.744), pytest.param(0.2, 0.572, marks=pytest.mark.slow), (0.5, 0.298)]
)
def test_two_disks_rebound_as_in_closed_form(lab, ratio, expected):
    """At the step of a run, some six in an impact, in the mean over places in the step at which contacts close."""
    assert restitution(ratio) == pytest.approx(expected, abs=5e-4)
    scene = lab.disks([[0.0, 0.0], [0.51, 0.0]], [0.25, 0.25], held=(), material=LOOSE | {"dp_nratio": ratio})
    for share, of_mean, of_each in ((0.9, 0.021, 0.07), (0.09, 0.002, 0.006)):
        step, found = share * step_limit(scene), []
        for part in np.arange(8) / 8.0:
            simulation = lab.simulation(scene, step=step)
            simulation.state.velocity = np.array([[1.0, -1.0], [0.0, 0.0], [0.0, 0.0]])
            simulation.state.u[0] += [part * step, -part * step]
            ledger = lab.ledger(simulation, 10)
            simulation.run(int(0.02 / step))
            last = ledger.entries[-1]
            found.append(simulation.state.velocity[0, 1])
            taken = last.damping + last.closing  # what a contact takes as it opens within a step is its own column
            assert taken == pytest.approx(625.0 * (1.0 - found[-1] ** 2), rel=1e-9)
            assert abs(last.error) < 1e-9 * taken
        assert np.mean(found) == pytest.approx(restitution(ratio), abs=of_mean)
        assert found == pytest.approx([restitution(ratio)] * 8, abs=of_each)


def matrices(lab, scene) -> tuple[np.ndarray, np.ndarray]:
    """M⁻¹ᐟ²KM⁻¹ᐟ² of a small lattice, and the same of its dashpots (3n, 3n), from their definition."""
    n, root = scene.count, 1.0 / np.sqrt(lab.inertia(scene)).ravel()
    stiffness = np.array([-lab.forces(scene, unit.reshape(3, n)).ravel() for unit in np.eye(3 * n)]).T
    viscosity = np.zeros((3 * n, 3 * n))
    material, moduli = scene.case.material, scene.ground.moduli
    for i, j in scene.assembly.pairs:
        x, y = (scene.positions[j] - scene.positions[i]) / np.hypot(*(scene.positions[j] - scene.positions[i]))
        reduced = scene.mass[i] * scene.mass[j] / (scene.mass[i] + scene.mass[j])
        normal, shear = np.zeros(3 * n), np.zeros(3 * n)
        normal[[i, j, n + i, n + j]] = -x, x, -y, y
        shear[[i, j, n + i, n + j, 2 * n + i, 2 * n + j]] = y, -y, -x, x, *-scene.assembly.radii[[i, j]]
        viscosity += 2.0 * material.dp_nratio * np.sqrt(reduced * moduli.emod) * np.outer(normal, normal)
        viscosity += 2.0 * material.dp_sratio * np.sqrt(reduced * moduli.emod / moduli.kratio) * np.outer(shear, shear)
    return root[:, None] * stiffness * root, root[:, None] * viscosity * root


def largest_step(stiffness: np.ndarray, viscosity: np.ndarray) -> float:
    """The step at which the largest eigenvalue of K + 2C/Δt is 4/Δt², by bisection."""
    low, high = 0.0, 2.0 / np.sqrt(np.linalg.eigvalsh(stiffness)[-1])
    for _ in range(40):
        step = 0.5 * (low + high)
        stable = np.linalg.eigvalsh(stiffness + 2.0 / step * viscosity)[-1] * step**2 < 4.0
        low, high = (step, high) if stable else (low, step)
    return low


@pytest.mark.parametrize(("ratio", "expected", "cost"), [(0.05, 0.91, 0.89), (0.2, 0.69, 0.63), (0.5, 0.43, 0.36)])
def test_steps_are_stable_up_to_that_of_stiffness_and_dashpots(lab, ratio, expected, cost):
    """A pressed lattice whose contacts stay closed is linear; the limit of runs also allows for loose disks."""
    material = BONDED | {"dp_nratio": ratio, "dp_sratio": ratio}
    scene = lab.scene("A", (2.5, 2.5), held=(), material=material, static={"stress": (-1e6, -1e6, 0.0)})
    stiffness, viscosity = matrices(lab, scene)
    exact, start = largest_step(stiffness, viscosity), settle(scene).start
    assert exact / largest_step(stiffness, 0.0 * viscosity) == pytest.approx(expected, abs=0.005)
    assert viscous_share(scene) == pytest.approx(cost, abs=0.005)
    assert step_limit(scene) < largest_step(stiffness / OPENING, viscosity)
    noise, left = 1e-9 * np.random.default_rng(0).standard_normal((3, scene.count)), []
    for share in (0.99, 1.01):
        simulation = lab.simulation(scene, start, share * exact)
        simulation.state.velocity = noise
        simulation.advance(200)
        left.append(np.abs(simulation.state.velocity).max())
    assert left[0] < 1e-8
    assert left[1] > 1e-7


def run(lab, size: tuple[float, float], steps: int, number: int = 1, **material) -> Simulation:
    """A run of grains that pulses break, with so many threads."""
    words = {"held": (), "boundary": SIDES, "wave": lab.pulse(0.01) | {"amplitude": 2.0}, "brick": (4.0, 4.0)}
    return lab.advanced(
        lab.simulation(lab.scene("B", size, **words, material=BRITTLE | RATIOS | material)), steps, number
    )


@pytest.mark.parametrize("geometry", ["updated", "reference"])
@pytest.mark.parametrize("size", [(40.0, 4.0), (8.0, 4.0)], ids=["rows of copies", "one by one"])
def test_same_bits_by_any_threads_and_after_a_cut_and_the_ledger_closes(lab, size, geometry, monkeypatch):
    monkeypatch.setattr(memory, "PARTICLES_PER_THREAD", 1)
    one, cut = (run(lab, size, 0, geometry=geometry) for _ in range(2))
    ledger = lab.ledger(one, 50)
    one.run(STEPS)
    two = run(lab, size, STEPS, 2, geometry=geometry)
    part = run(lab, size, 101, geometry=geometry)
    cut.state.take(part.state.arrays())
    cut.advance(STEPS - 101)
    (contacts,) = one.system.contacts.values()
    assert (contacts.rows is not None) == (size == (40.0, 4.0))
    assert contacts.origin.any() or geometry == "reference"  # pairs were listed anew
    assert len(one.system.take_cracks(STEPS)) > 20
    for other in (two, cut):
        assert np.array_equal(one.state.velocity, other.state.velocity)
        assert np.array_equal(one.state.work, other.state.work)
    last = ledger.entries[-1]
    assert last.damping > 0.01 * last.supplied
    assert abs(last.error) < 3e-4 * last.supplied


def test_a_settled_body_stays_at_rest_to_the_bit(lab):
    words = {"held": (), "static": {"stress": (-1e6, -1e6, 0.0), "ratio": 1e-9}, "brick": (4.0, 4.0)}
    scene = lab.scene("B", (4.0, 4.0), **words, material=BONDED | RATIOS)
    simulation = lab.simulation(scene, settle(scene).start)
    simulation.advance(100)
    assert not simulation.state.velocity.any()


def test_debris_comes_to_rest_by_dashpots(lab):
    """Loose disks at 1 m/s fall on each other between fixed sides; after half a second friction alone leaves 0.35 J."""
    sides, weight = dict.fromkeys(("left", "right", "bottom"), "fixed"), [{"acceleration": [0.0, -9.81]}]
    left = []
    for ratios in ({}, RATIOS):
        material = LOOSE | {"emod": 1e8} | ratios
        scene = lab.scene("A", (2.5, 2.5), held=(), boundary=sides, material=material, load=weight)
        simulation = lab.simulation(scene)
        thrown = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
        simulation.state.velocity = scene.moves * thrown * np.array([[1.0], [1.0], [0.0]])
        simulation.advance(int(0.5 / simulation.time_step))
        left.append(np.sum(lab.inertia(scene) * simulation.state.velocity**2))
    assert left[1] < 1e-3 * left[0]

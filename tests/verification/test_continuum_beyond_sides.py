"""A body with a continuum beyond its sides moves as one of particles alone that is so large that nothing returns."""

from itertools import pairwise

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

SIDES = ("left", "right", "bottom")
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.1}
MATERIAL = {"fric": 0.5, "p_wave_speed": 1000.0}  # isotropic, ν = 0: c_s = 707 m/s


def surrounded(lab, **changes):
    """Lamb's problem on 40 m × 20 m of disks of 1 m."""
    load = [{"name": "f", "position": [20.5, 19.5], "force": [3e5, -1e6], "wave": "pulse"}]
    return lab.case(
        "A",
        (40.0, 20.0),
        radius=0.5,
        held=(),
        material=MATERIAL,
        boundary=dict.fromkeys(SIDES, "outside"),
        wave=PULSE,
        load=load,
        **changes,
    )


def moved(case, places, steps: int, step: float) -> np.ndarray:
    """Displacements and velocities (steps, p, 4) at places (p, 2) m."""
    scene = build(case)
    disks = scene.positions[: scene.recorded]
    nodes = [int(np.argmin(np.hypot(*(disks - place).T))) for place in places]
    assert np.abs(disks[nodes] - places).max() < 1e-9
    return Simulation(scene, step, nodes).advance(steps)[:, :, [0, 1, 3, 4]]


def test_lambs_problem_is_that_of_a_large_body(lab) -> None:
    """Up to 0.2 s, when the P wave of the far sides of 320 m × 160 m returns.

    Elements are chosen for an error of 0.1 % of all velocities; at the surface, where Rayleigh waves have more of the
    high frequencies, they have up to 0.3 %, and displacements up to 0.05 %.
    """
    case = surrounded(lab)
    step = choose_step(build(case))[0]
    steps = int(0.2 / step)
    places = np.array([[25.5, 19.5], [35.5, 19.5], [20.5, 9.5], [30.5, 4.5]])
    small = moved(case, places, steps, step)
    load = [{"name": "f", "position": [160.5, 159.5], "force": [3e5, -1e6], "wave": "pulse"}]
    far = with_changes(case, {"packing.size": [320.0, 160.0], "boundary": {}, "load": load})
    large = moved(far, places + 140.0, steps, step)
    error = np.sqrt(np.sum((small - large) ** 2, axis=0) / np.sum(large**2, axis=0).max(axis=0))
    assert error[:, :2].max() < 7e-4
    assert error[:, 2:].max() < 4e-3


def test_energy_that_leaves_is_in_the_ledger(lab) -> None:
    """To rounding, over 2,000 steps, in which nearly all of it is absorbed."""
    scene = build(surrounded(lab))
    simulation = Simulation(scene, choose_step(scene)[0], side_stride=1)
    ledger = Ledger(simulation, 100)
    simulation.track(ledger)
    simulation.run(2001)
    last = ledger.entries[-1]
    most = max(entry.supplied for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-12 * most
    assert last.damping == pytest.approx(last.loads, rel=0.01)
    assert last.loads > 0.1 * most
    # what the disks lose through their ties the continuum gets, but for the ties' dashpots
    of = dict(zip(ledger.side_names, ledger.side_columns[-1], strict=True))
    out = -sum(of[side][0] for side in SIDES)
    into = sum(of[f"{side}.continuum"][0] for side in SIDES)
    assert out == pytest.approx(last.loads, rel=0.02)
    assert 0.98 * out < into < out


def test_a_continued_run_has_the_same_bits(lab) -> None:
    scene = build(surrounded(lab))
    step = choose_step(scene)[0]
    whole = Simulation(scene, step)
    whole.run(300)
    first, second = Simulation(scene, step), Simulation(build(surrounded(lab)), step)
    first.run(117)
    second.state.take(first.state.arrays())
    second.run(300)
    assert np.abs(whole.state.u).max() > 0.0
    assert np.array_equal(whole.state.u, second.state.u)
    assert np.array_equal(whole.state.v, second.state.v)


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_noise_decays(lab, pattern) -> None:
    """At the automatic step, with dashpots of ties that lag and the layer's delay in its limit.

    Only the dashpots take out what the elements cannot carry away: without them 7 times (A) and 200 times (B) as much
    of the noise is left after 12,000 steps as with them.
    """
    packing = {"pattern": "A", "size": [40.0, 20.0], "radius": 0.5}
    if pattern == "B":
        packing |= {"pattern": "B", "radius_ratio": 1.5, "brick": [10.0, 10.0], "seed": 1}
    energies = []
    for changes in ({}, {"outside.damping": 0.0}):
        scene = build(with_changes(surrounded(lab), {"packing": packing} | changes))
        simulation = Simulation(scene, choose_step(scene)[0])
        noise = np.random.default_rng(7).normal(size=(3, scene.count))
        noise[:, scene.recorded :] = 0.0
        simulation.state.velocity = noise
        energies.append([])
        for steps in (10, 3000, 6000, 12000):
            simulation.run(steps)
            energies[-1].append(float(np.sum(scene.mass * simulation.state.velocity[:2] ** 2)))
    with_dashpots, without = energies
    assert all(later < 0.75 * earlier for earlier, later in pairwise(with_dashpots))
    assert 0.0 < with_dashpots[-1] < 0.25 * without[-1]


def test_noise_in_the_continuum_alone_decays(lab) -> None:
    """All that can move is absorbed: rotations and outer edges of the continuum, which are at rest, have no noise."""
    scene = build(surrounded(lab))
    assert not scene.moves[2, scene.recorded :].any()
    assert 0 < np.count_nonzero(~scene.moves[0, scene.recorded :]) < 0.2 * scene.outside.count
    simulation = Simulation(scene, choose_step(scene)[0])
    noise = np.random.default_rng(8).normal(size=(3, scene.count)) * scene.moves
    noise[:, : scene.recorded] = 0.0
    simulation.state.velocity = noise
    first = float(np.sum(scene.mass * noise[:2] ** 2))
    simulation.run(3000)
    assert float(np.sum(scene.mass * simulation.state.velocity[:2] ** 2)) < 1e-2 * first

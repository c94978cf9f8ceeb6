"""Noise in a continuum with absorbing layers decays, alone and round disks; without the delay τ it grows.

Noise is in all that moves, the layers' nodes included. What remains longest is slow motion of the layers, which decays
with their α, and short waves at corners of free edges, which no wave of the elements can carry away.
"""

import numpy as np
import pytest
from decay import disks_and_grid, grid_alone, kinetic

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

SAMPLES = 40


def evenly(steps: int) -> list[int]:
    return [k * steps // SAMPLES for k in range(1, SAMPLES + 1)]


@pytest.mark.parametrize("ratio", [0.25, *(pytest.param(other, marks=pytest.mark.slow) for other in (0.0, 0.4))])
def test_noise_decays(ratio: float) -> None:
    energies = kinetic(grid_alone(ratio), evenly(80_000))

    assert energies.max() < 1.0
    assert energies[-4:].max() < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("box", [None, (5, 4, 7, 6), (5, 4, 7, 5)], ids=["full", "to the surface", "hole"])
@pytest.mark.parametrize("ratio", [0.0, 0.25, 0.4])
def test_noise_decays_for_long(ratio: float, box: tuple[int, int, int, int] | None) -> None:
    energies = kinetic(grid_alone(ratio, box=box), evenly(200_000))

    assert energies.max() < 1.0
    assert energies[30:].max() < energies[:10].max()


@pytest.mark.slow
@pytest.mark.parametrize("order", [3, 5, 6])
def test_noise_decays_in_elements_of_other_orders(order: int) -> None:
    energies = kinetic(grid_alone(order=order), evenly(200_000))

    assert energies.max() < 1.0
    assert energies[-4:].max() < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize(("pattern", "fric"), [("A", 0.5), ("A", 0.0), ("B", 0.5), ("B", 0.0)])
def test_noise_round_disks_decays_for_long(pattern: str, fric: float) -> None:
    """At the automatic step, with a hole and a free surface; B traps short waves, which decay slowly."""
    energies = kinetic(disks_and_grid(pattern, fric), evenly(200_000))

    assert energies.max() < 1.0
    assert energies[30:].max() < energies[:10].max()
    assert energies[-4:].max() < (2e-2 if pattern == "B" else 1e-4)


@pytest.mark.slow
def test_without_the_delay_it_grows() -> None:
    """The known failure of spectral elements with a layer of this kind: by ten orders of magnitude in 40,000 steps."""
    energies = kinetic(grid_alone(delay=0.0), evenly(40_000))

    assert energies[-1] > 1e10
    assert (np.diff(np.log(energies[20:])) > 0.0).all()


@pytest.mark.parametrize("where", ["disks", "continuum"])
def test_dashpots_of_ties_take_out_noise_that_elements_cannot_carry_away(lab, where: str) -> None:
    """Noise of random disks: without dashpots ten times as much is left after 6,000 steps; in the continuum all goes.

    Rotations and outer edges of the continuum, which are at rest, have no noise.
    """
    words = {"held": (), "boundary": dict.fromkeys(("left", "right", "bottom"), "outside"), "material": {"fric": 0.5}}
    left = []
    for damping in ({}, {"damping": 0.0}):
        scene = build(with_changes(lab.case("B", (20.0, 10.0), **words), {"outside": {"element": 5.0} | damping}))
        assert not scene.moves[2, scene.recorded :].any()
        simulation = Simulation(scene, choose_step(scene)[0])
        noise = np.random.default_rng(7).normal(size=(3, scene.count)) * scene.moves
        noise[:, slice(scene.recorded, None) if where == "disks" else slice(scene.recorded)] = 0.0
        simulation.state.velocity = noise
        simulation.run(6000)
        left.append(
            float(np.sum(scene.mass * simulation.state.velocity[:2] ** 2) / np.sum(scene.mass * noise[:2] ** 2))
        )
    if where == "disks":
        assert 0.0 < left[0] < 0.1 * left[1]
    else:
        assert max(left) < 0.05

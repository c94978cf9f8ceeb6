"""Pieces that break off a stressed body fly on without the force that balanced its stress."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.motion.simulation import Simulation

SPEED = 100.0
"""m/s with which the corner is torn off, so that nothing which the stress throws after it can reach it.

A disk beside the gap keeps its force, of some σD, until its last bond has broken. Over a way of D that gives it
√(2σ/ρ), 57 m/s at 4 MPa; 47 m/s were seen.
"""

LEG = 200
"""Steps, 0.03 s, in which the corner comes off, and again as many for which it flies."""


@dataclass(frozen=True)
class Torn:
    """A body of which a corner was torn off, and what was so after each of two legs.

    momenta : (3, 2, n) N·s of each disk, at the start too. balancing, steady : (2, 3, n) N and N·m on each disk.
    """

    simulation: Simulation
    corner: np.ndarray
    momenta: np.ndarray
    balancing: np.ndarray
    steady: np.ndarray


@pytest.fixture(scope="module")
def torn(lab):
    """Tears the corner off a body of 10 m × 10 m under an isotropic stress; each once."""

    @cache
    def tear(stress: float, geometry: str) -> Torn:
        material = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e6, "pb_coh": 3e6, "geometry": geometry}
        scene = lab.scene("B", (10.0, 10.0), held=(), material=material, static={"stress": (stress, stress, 0.0)})
        simulation = lab.simulation(scene, settle(scene).start)
        corner = np.hypot(*(scene.positions - [10.0, 10.0]).T) < 1.5
        simulation.state.v[:2, simulation.state.layout.slot[corner]] = SPEED / np.sqrt(2.0)
        momenta, balancing, steady = [scene.mass * simulation.state.velocity[:2]], [], []
        for _ in range(2):
            simulation.advance(LEG)
            assert simulation.system.balance is not None
            momenta.append(scene.mass * simulation.state.velocity[:2])
            balancing.append(simulation.system.balance.force.copy())
            steady.append(np.array(simulation.system.steady))
        return Torn(simulation, corner, np.array(momenta), np.array(balancing), np.array(steady))

    return tear


@pytest.mark.parametrize(
    ("stress", "geometry"), [(-4e6, "updated"), pytest.param(0.3e6, "reference", marks=pytest.mark.slow)]
)
def test_a_corner_torn_off_gains_no_speed(lab, torn, stress, geometry):
    """Known failure: forces that go on tear at disks of 0.5 m with 800 m/s² per MPa, 7 m/s in a leg at 0.3 MPa."""
    body = torn(stress, geometry)
    assert not body.balancing[:, :, body.corner].any()
    # nothing but what touches it pushes it from here on
    assert not body.steady[:, :, body.corner].any()
    start, off, flown = body.momenta[..., body.corner]
    # a body has stored σ²/(C11 + C12) per area, less than σ²/ρc², in contacts and bonds; a corner at most twice that,
    # as all of those to the rest count. All of it as motion is 2σ/ρc, in the root of the mean of squares
    mass = body.simulation.scene.mass[body.corner]
    assert np.sum((off - start) ** 2 / mass) < np.sum(mass) * (2.0 * stress / (lab.density * lab.speed)) ** 2
    # then it touches nothing, and its disks only each other: 200 steps of rounding of forces on disks
    assert np.abs((flown - off).sum(axis=1)).max() < 200 * 1e-15 * np.abs(start).sum()
    # on the rest the forces act on
    assert body.balancing[-1][:, ~body.corner].any()


def test_the_rest_is_not_pushed_away(torn):
    """Known failure: if nothing made up for the forces that end, a net force of 6.2 MN would stay, 25 m/s²."""
    body = torn(-4e6, "updated")
    # what remains is that torn sides turn against each other: by 1e-3, some 120 forces of σD = 2 MN, 0.24 MN
    net = np.abs(np.diff(body.momenta.sum(axis=2), axis=0)).max(axis=1) / (LEG * body.simulation.time_step)
    assert np.all(net < 1e-3 * 120 * 2.0e6)

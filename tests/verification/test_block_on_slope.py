"""A block on a slope rests below its friction angle; above it slides down with a = g(sin α − μ cos α).

The slope is a row of fixed disks, the block a row of bonded ones that stand on them and do not turn. It is gravity that
is tilted.
"""

from collections.abc import Sequence

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene
from dembound.motion.simulation import Simulation

DISKS, RADIUS = 4, 0.25
MASS = 2500.0 * (2.0 * RADIUS) ** 2
FRICTION = 0.5
KRATIO = 2.0
EMOD = 0.5 * 2500.0 * 1000.0**2  # of contacts and bonds alike
GRAVITY = 9.81
RATIO = 1e-9
STEP = 0.02 * np.sqrt(MASS / EMOD)


def block_on_slope(lab, loads: Sequence[dict]) -> DiskScene:
    """Disks 0 to 3 are the slope, 4 to 7 the block above them."""
    along = 2.0 * RADIUS * np.arange(DISKS)
    material = {"law": "linearpbond", "kratio": KRATIO, "fric": FRICTION}
    return lab.disks(
        [(x, y) for y in (0.0, 2.0 * RADIUS) for x in along],
        np.full(2 * DISKS, RADIUS),
        [(k, k + 1) for k in range(DISKS, 2 * DISKS - 1)],
        s_speed=0.5 * lab.speed,
        held=("rotation",),
        material=material | {"elastic_start": False},
        boundary={"bottom": "fixed"},
        load=loads,
        static={"ratio": RATIO, "boundary": {"bottom": {"type": "fixed"}}},
        wave={"type": "constant", "amplitude": 1.0},
    )


def tilted(angle: float) -> tuple[float, float]:
    """Gravity (m/s²) along and across a slope of an angle in degrees."""
    return GRAVITY * np.sin(np.radians(angle)), -GRAVITY * np.cos(np.radians(angle))


def on_the_slope(simulation: Simulation) -> np.ndarray:
    """Forces (DISKS, 2) N from the block on the slope."""
    pairs = simulation.system.contacts["body"].arrays
    standing = (pairs.first < DISKS) & (pairs.second >= DISKS) & pairs.force[:2].any(axis=0)
    return pairs.force[:2, standing].T


def test_below_the_friction_angle_it_rests(lab):
    along, across = tilted(26.0)  # tan⁻¹ 0.5 = 26.57°
    scene = block_on_slope(lab, [{"acceleration": (along, across)}])
    settled = settle(scene)
    simulation = lab.simulation(scene, settled.start, STEP, np.arange(DISKS, 2 * DISKS))

    # the mean force left is RATIO of that in a contact, MASS·g; all of it may be left on one disk
    left = 2 * DISKS * RATIO * MASS * GRAVITY
    np.testing.assert_allclose(on_the_slope(simulation), [MASS * np.array([along, across])] * DISKS, atol=left)
    assert not simulation.advance(1000).any()


@pytest.mark.parametrize("angle", [27.0, 45.0])
def test_above_the_friction_angle_it_slides(lab, angle):
    along, across = tilted(angle)
    # across the slope it has come to rest before what pulls it along is switched on
    pull = {"acceleration": (along, 0.0), "wave": "pulse"}
    scene = block_on_slope(lab, [{"acceleration": (0.0, across)}, pull])
    simulation = lab.simulation(scene, settle(scene).start, STEP, np.arange(DISKS, 2 * DISKS))
    record = simulation.advance(400)
    assert simulation.system.contacts["body"].arrays.slip.any()

    velocity = record[200:, :, 3]
    acceleration = np.diff(velocity, axis=0) / STEP
    # after a way s the contacts have turned by s/D, and with them the forces; that the disks' tops are off by s²/2D
    # changes what presses them by k_n s²/2D at the most
    way = record[:, :, 0].max()
    turn = way / (2.0 * RADIUS)
    pressed = 0.5 * EMOD * way * turn / MASS
    expected = along + FRICTION * across
    np.testing.assert_allclose(acceleration, expected, rtol=0.0, atol=2.0 * turn * GRAVITY + FRICTION * pressed)

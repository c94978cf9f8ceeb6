"""What the disks of a side carry when others come off, and the work of forces at rest against their side's motion."""

import numpy as np
import pytest
from disk_systems import BODY, FREE_FIELD, TWO_BRICKS, shaken

from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.carriers import carriers_of, on_side, standing
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contacts import TENSION

LATTICE = {"pattern": "A", "size": [6.0, 5.0], "radius": 0.25}
PERIODIC = {side: {"type": "periodic"} for side in ("left", "right")}
STEP = 0.1


@pytest.fixture
def scene(bar):
    """Makes twelve disks by ten under some sides, or other packings."""

    def make(packing: dict = LATTICE, **boundary: dict) -> DiskScene:
        return build(bar({**BODY, "material.law": "linearpbond", "packing": packing, "boundary": boundary}))

    return make


def isolate(system: DiskSystem, particles: np.ndarray) -> None:
    """Break all bonds of some particles in all parts."""
    for part in system.parts:
        pairs = part.pairs
        hit = (np.isin(pairs.first, particles) | np.isin(pairs.second, particles)) & (pairs.cracked < 0)
        pairs.state[hit], pairs.cracked[hit] = TENSION, 1


@pytest.mark.parametrize("sides", [{}, FREE_FIELD, PERIODIC], ids=["free", "free field", "periodic"])
def test_breaks_at_random_leave_the_sum_of_forces_of_every_side(scene, sides) -> None:
    """In the body and in its column, and of periodic bodies too, as long as half of the side is left."""
    body = scene(TWO_BRICKS, **sides)
    system, rng = DiskSystem(body, STEP), np.random.default_rng(11)
    across = np.zeros((3, body.count))
    if body.seams:
        across[:, body.seams[0].node] = rng.uniform(-1.0, 1.0, (3, len(body.seams[0].node)))
    carriers, still = carriers_of(body), np.zeros((3, body.count))
    force = shaken(body, 1.0, 1)
    force[:, np.setdiff1d(np.arange(body.count), np.concatenate([each.nodes for each in carriers]))] = 0.0
    balance = Balance(body, force, shaken(body, 1.0, 2), shaken(body, 0.1, 3), across)

    def sums() -> np.ndarray:
        acting = balance.force + np.where(balance.let_go, 0.0, across)
        return np.array([on_side(each, acting)[:2].sum(axis=1) for each in carriers])

    load, before = balance.force.copy(), sums()
    ended = []
    for _ in range(6):
        isolate(system, rng.choice(body.count, 3, replace=False))
        for pairs in system.contacts.values():
            pairs.arrays.force[:] = 0.0
        balance.end_on_debris(system.disks.parts, still, still, STEP, load, None)
        ended.append(int((~balance.force.any(axis=0)).sum()))
    assert ended[-1] > 10
    np.testing.assert_allclose(sums(), before, rtol=0.0, atol=1e-12)  # some thirty terms of size 1
    assert standing(carriers, ~balance.force[:2].any(axis=0), balance.force).all()

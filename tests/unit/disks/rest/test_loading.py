"""Loading in a static stage: the end of the elastic path, balance there, and the step when all loads act."""

from types import SimpleNamespace

import numpy as np
import pytest
from settling import scene

from dembound.disks.rest.loading import LEAST, LOOK, Loading
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.simulation import Simulation

SHEAR = 0.4e6
STRESS = {"ratio": 1e-8, "stress": [-1e6, -1e6, SHEAR]}
LAW = {"material.law": "linearpbond", "material.fric": 2.0, "packing.size": [8.0, 8.0]}
K = 2500.0 * 1000.0**2


def sheared(bar, **changes: object) -> SimpleNamespace:
    """A lattice at its start, with the displacements (3, n) at which it is at rest under the elastic law."""
    whole = scene(bar, static=STRESS, **{**LAW, **changes})
    body = StaticScene(whole, whole.case.static)
    none = np.zeros((3, whole.count))
    system = DiskSystem(body.scene, 1e-5, settling=True, load=body.load(none))
    state = Simulation(body.scene, 1e-5, system=system).state
    x, y = whole.positions.T
    # k = K for normals and shears, and two shears a half each without rotation of disks
    rest = np.stack([-1e6 / K * x + SHEAR / K * y, -1e6 / K * y + SHEAR / K * x, 0.0 * x])
    return SimpleNamespace(body=body, system=system, state=state, rest=rest, loading=Loading(body, system, none, 1e-4))


def out_of_balance(found: SimpleNamespace) -> np.ndarray:
    """Forces (3, n) of contacts and loads at the present displacements."""
    for pairs in found.system.contacts.values():
        pairs.push(found.state.displacement)
    return found.system.forces.last(found.system.contacts) + found.system.load


@pytest.mark.parametrize("share", [0.25, 0.6])
def test_the_elastic_way_ends_where_the_first_bond_is_at_its_strength(bar, share: float) -> None:
    """Bonds have half of the shear stress, as contacts are as stiff; nothing is out of balance where it ends."""
    found = sheared(bar, **{"material.pb_coh": share * 0.5 * SHEAR, "material.geometry": "reference"})
    found.state.displacement = found.rest
    assert not found.loading.is_the_answer(found.state)
    assert found.system.uses_history
    reached = np.abs(found.state.displacement).max() / np.abs(found.rest).max()
    assert share - 2.0**-11 < reached <= share
    assert len(found.system.contacts["body"].take_cracks()) == 0

    found.loading.put_on(found.state)
    assert np.abs(out_of_balance(found)).max() < 1e-9 * 1e6
    ends = LOOK * int(np.ceil((1.0 - reached) * LEAST))
    assert [found.loading.is_rising(step) for step in (0, ends - 1, ends)] == [True, True, False]
    # half-way there is half of what remains, at the end all
    left = []
    for found.state.step in (0, ends // 2, ends):
        found.loading.put_on(found.state)
        left.append(np.abs(found.system.load - found.body.load(found.state.displacement)).max())
    assert left[1] == pytest.approx(0.5 * left[0], rel=LOOK / ends)
    assert left[2] == 0.0
    assert left[0] == pytest.approx((1.0 - reached) * 0.5 * 1e6, rel=0.5)  # of a disk at a side, with its shear

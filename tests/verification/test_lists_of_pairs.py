"""Motion, cracks and energies do not depend, to the bit, on when pairs are listed, nor on how many open ones are.

A pair that parts forgets its shear, one that meets again has the constants as built, and pairs in rows stay listed. So
the list needs only to be complete, and a pair that is missing from it would be seen.
"""

import hashlib

import numpy as np
import pytest
from small_cases import small

from dembound.disks.contacts import relisting, skins
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.rest.stage import settle
from dembound.motion.simulation import Simulation
from dembound.running import plan

HEAP = {
    "packing": {"pattern": "B", "size": [8.0, 8.0], "brick": [4.0, 4.0], "radius": 0.2, "radius_ratio": 1.5, "seed": 2},
    "material": {"density": 2200.0, "law": "linearpbond", "emod": 2e8, "pb_emod": 0.0, "fric": 0.4, "dp_nratio": 0.2},
    "boundary": {"bottom": {"type": "fixed"}},
    "load": [{"name": "weight", "acceleration": [3.0, -9.81]}],
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}
"""Unbonded disks that tumble to one side."""

ROCK = HEAP | {
    "material": {
        "density": 2500.0,
        "p_wave_speed": 2e3,
        "law": "linearpbond",
        "fric": 0.5,
        "pb_ten": 2e5,
        "pb_coh": 3e5,
    },
    "boundary": {},
    "load": [{"name": "blow", "region": [3.0, 3.0, 4.0, 4.0], "force": [2e7, 7e6], "wave": "kick"}],
    "wave": {"kick": {"type": "triangle", "amplitude": 1.0, "rise": 1e-3, "fall": 1e-3}},
}
"""Bonded disks in rows of copies, some of which are torn out and thrown through the others."""


def tumbling(lab) -> Simulation:
    """The heap from the start."""
    return begun(HEAP)


def blown(lab) -> Simulation:
    """The rock from the start."""
    return begun(ROCK)


def torn(lab) -> Simulation:
    """Stressed rock whose corner is torn off slowly, so that pieces also part without a break."""
    material = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e6, "pb_coh": 3e6}
    scene = lab.scene("B", (10.0, 10.0), held=(), material=material, static={"stress": (-4e6, -4e6, 0.0)})
    run = lab.simulation(scene, settle(scene).start)
    corner = np.hypot(*(scene.positions - [10.0, 10.0]).T) < 3.0
    run.state.v[:2, run.state.layout.slot[corner]] = 15.0
    return run


def begun(tables) -> Simulation:
    """The simulation of a case."""
    planned = plan(small(tables))
    run = Simulation(planned.scene, planned.time_step)
    run.track(*planned.kind.trackers(run))
    return run


def outcome(run: Simulation, steps: int, every: int = 0) -> tuple[str, list[list[int]], int]:
    """A digest of motion and energies after some steps, broken bonds, and how often pairs were listed.

    every : steps after which they are listed in any case; 0: only when they must be.
    """
    listed, list_anew = 0, ContactList.list_anew

    def counted(self, *words):
        nonlocal listed
        listed += 1
        list_anew(self, *words)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ContactList, "list_anew", counted)
        for step in [*range(every, steps, every or steps), steps] if every else [steps]:
            run.run(step)
            for pairs in run.system.contacts.values() if every else ():
                pairs.list_anew(run.state.u, run.state.v)
    cracks = run.system.take_cracks(steps)
    state = run.state
    motion = np.ascontiguousarray([state.displacement, state.velocity])
    energy = np.array([*state.work[0], *(each for part in run.system.parts for each in part.stored(state.u))])
    return hashlib.sha256(motion.tobytes() + energy.tobytes()).hexdigest(), cracks.pair.tolist(), listed


@pytest.mark.parametrize(
    ("make", "steps"), [pytest.param(tumbling, 1500, marks=pytest.mark.slow), (blown, 2500), (torn, 500)]
)
def test_listings_change_no_bit(lab, make, steps, monkeypatch) -> None:
    *usual, count = outcome(make(lab), steps)
    for every, changes in ((1, {}), (7, {}), (0, {"AHEAD": 0.0}), (0, {"AHEAD": 80.0}), (0, {"MOVING": 0.1})):
        with monkeypatch.context() as patch:
            for name, value in changes.items():
                patch.setattr(skins, name, value)
            *found, other = outcome(make(lab), steps, every)
        assert found == usual, (every, changes)
        assert other > count or not every
    assert count > 2
    assert (make is tumbling) == (usual[1] == [])


@pytest.mark.slow
def test_a_missing_pair_is_seen(lab, monkeypatch) -> None:
    *usual, _ = outcome(tumbling(lab), 1500)
    found_by = relisting.near_keys
    monkeypatch.setattr(relisting, "near_keys", lambda *words: found_by(*words)[::2])
    *found, _ = outcome(tumbling(lab), 1500)
    assert found != usual

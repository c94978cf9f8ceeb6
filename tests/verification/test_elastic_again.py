"""After a static stage in which contacts slid, the elastic law computes the motion of the history-dependent law.

A square lattice under a target stress with shear: contacts slide on the way to rest and stick when it is reached, some
with a slip that remains.
"""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest

from dembound.disks.reduced import reduced
from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.disks.stepping.first_law import elastic_again, never_elastic_again, settled_slip
from dembound.kernels.contacts import SHEAR
from dembound.kinds import with_changes

EPS = np.finfo(float).eps
STRESS = 1e6
WEAK, STRONG = 0.01, 0.3
"""m/s: nothing slides, and sliding begins before the end."""

STEPS = 250

ELASTIC = {"density": 2500.0, "p_wave_speed": 1000.0, "law": "elastic"}


def sheared(lab, geometry, amplitude=WEAK, stress=(-STRESS, -STRESS, 0.2 * STRESS), **material):
    material = {"law": "linearpbond", "geometry": geometry, "fric": 0.5, "pb_ten": 5e7, "pb_coh": 5e7} | material
    return lab.case(
        "A",
        (20.0, 10.0),
        held=(),
        material=material,
        boundary={"left": {"type": "viscous_input", "wave_p": "pulse"}},
        wave=lab.pulse(0.02) | {"amplitude": amplitude},
        static={"damp": 0.3, "stress": list(stress)},
    )


def settled(case):
    """The start of a run whose static stage ended under the law with history, and whose contacts have slid.

    Without an elastic start this law takes over at the end of the stage. Contacts have slid by a fifth of their shear;
    what is then out of balance is balanced as any settled stress is.
    """
    start = settle(build(with_changes(case, {"material.elastic_start": False}))).start
    pairs = start.contacts["body"].arrays
    pairs.slip[:] = 0.2 * pairs.shear
    return start


def run(lab, case, *, elastic):
    """The simulation of a case after its static stage, and the motion (k, n, 6) of all particles."""
    scene = build(with_changes(case, {"reduce.settled": elastic}))
    simulation = lab.simulation(scene, settled(case), probes=np.arange(scene.count))
    ledger = lab.ledger(simulation, 10)
    return simulation, simulation.advance(STEPS), ledger


def largest(motion, columns):
    return np.abs(motion[..., columns]).max()


@pytest.mark.parametrize("amplitude", [pytest.param(WEAK, marks=pytest.mark.slow), STRONG])
def test_small_displacements_agree_to_rounding(lab, amplitude):
    case = sheared(lab, "reference", amplitude)
    full, expected, _ = run(lab, case, elastic=False)
    again, motion, ledger = run(lab, case, elastic=True)

    assert full.state.laws == [("linearpbond", 0)]
    names = [name for name, _ in again.state.laws]
    assert names == (["elastic"] if amplitude == WEAK else ["elastic", "linearpbond"])
    slid = again.system.parts[0].contacts.of("slip")
    assert np.abs(slid).max() > 1e-3 * np.abs(again.state.datum).max()  # what a start without history would forget
    # the settled forces, against which the wave's are rounded, are this much larger than those of ρcv
    ratio = STRESS / (lab.density * lab.speed * amplitude)
    assert largest(motion - expected, slice(3, 5)) < ratio * EPS * STEPS * largest(expected, slice(3, 5))
    kinetic = ledger.columns[:, 1].max()
    assert np.abs(ledger.columns[:, -1]).max() < ratio**2 * EPS * STEPS * kinetic


def test_fields_of_stress_are_those_of_contacts_that_slid(lab):
    """They are those of the other law, as bonds keep their vectors, and so are the forces of contacts.

    Without their slip, contacts would have a thousandth of the largest displacement more shear: 8 kPa.
    """
    stresses, forces = [], []
    for elastic in (False, True):
        scene = build(with_changes(sheared(lab, "reference"), {"reduce.settled": elastic, "output.contacts": True}))
        start = settle(scene).start
        simulation = lab.simulation(scene, start)
        simulation.advance(1)
        stresses.append(simulation.system.stress(start.displacement))
        columns = simulation.system.contact_forces(start.displacement)
        forces.append(np.stack([columns[f"{name}_force"][0] for name in ("normal", "shear")]))
    # forces of stretches of 1e-4 m, which are differences of displacements of 1e-2 m, times some ten operations
    rounding = 1e3 * EPS
    np.testing.assert_allclose(*stresses, rtol=0.0, atol=rounding * STRESS)
    np.testing.assert_allclose(*forces, rtol=0.0, atol=rounding * np.abs(forces[0]).max())


CHANGED = "after the static stage a contact has opened or closed or slides, or a bond is at its strength"
REFUSED = "reduce.settled: not applied: "


def test_cases_that_are_never_elastic_again(lab):
    case = with_changes(sheared(lab, "reference"), {"reduce.settled": True})
    assert (
        never_elastic_again(with_changes(case, {"material": ELASTIC}))
        == 'material.law = "elastic" is used from the start'
    )
    seam = {"material.locked_in": 1e5, "boundary.right": {"type": "free_field"}, "static": {"damp": 0.3}}
    assert "a locked-in stress acts through the seam of the free field" in never_elastic_again(with_changes(case, seam))
    assert reduced(build(replace(case, static=None))).refused == (f"{REFUSED}there is no static stage",)


@pytest.mark.parametrize(
    ("words", "asked_for", "refused"),
    [
        ({}, False, ()),
        ({"stress": (0.2 * STRESS, -STRESS, 0.3 * STRESS)}, True, (f"{REFUSED}{CHANGED}",)),
        ({"elastic_start": False}, True, (f"{REFUSED}material.elastic_start is false",)),
    ],
    ids=["off by default", "contacts are open", "no elastic start"],
)
def test_other_bodies_keep_the_law_with_history(lab, words, asked_for, refused):
    case = sheared(lab, "reference", **words)
    scene, start = build(with_changes(case, {"reduce.settled": True} if asked_for else {})), settled(case)
    assert start.has_history
    simulation = lab.simulation(scene, start)
    assert simulation.state.laws == [("linearpbond", 0)]
    assert simulation.system.saved(simulation.state) == ()
    assert (*reduced(scene).refused, *simulation.system.refused) == refused


SPOILT = {
    "a broken bond": "a bond broke in the static stage",
    "a contact missing": "disks that touched at the start are far apart",
    "a contact about to slide": CHANGED,
    "an open contact": CHANGED,
}


def test_a_single_pair_keeps_the_law_with_history(lab):
    scene = build(with_changes(sheared(lab, "reference"), {"reduce.settled": True}))
    settled_start = settle(scene).start
    for spoil, reason in SPOILT.items():
        start = deepcopy(settled_start)
        pairs = start.contacts["body"]
        assert not isinstance(settled_slip(pairs, start.displacement), str)

        k, moved = pairs.live[700], start.displacement.copy()
        if spoil == "a broken bond":
            pairs.arrays.state[k] = SHEAR
        elif spoil == "a contact missing":
            pairs.live = np.delete(pairs.live, 700)
        elif spoil == "a contact about to slide":
            pairs.arrays.slip[k] += 1e-3
        else:
            moved[:, 300] += 1e-3
        assert elastic_again([pairs], moved) == reason, spoil
        assert not pairs.keeps_slip

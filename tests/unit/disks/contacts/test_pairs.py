"""Forces across contacts: signs and sums; the first broken bonds of a run, found without a record."""

import numpy as np
import pytest
from disk_systems import BODY, DENSE

from dembound.disks.contacts.pairs import (
    BREAK_TIME,
    BREAK_X,
    BREAK_Y,
    contact_columns,
    first_break,
    pieces,
    plain_contacts,
)
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.kernels.contacts import INTACT, REFERENCE, SHEAR, TENSION
from dembound.kinds.disks.kind import Disks
from dembound.motion.simulation import Simulation

BONDS = {
    "material.law": "linearpbond",
    "material.contact_share": 0.0,
    "material.pb_ten": 0.4e6,  # a compressive pulse of 1.25 MPa comes back from the free end as tension
    "motion.held": ["y", "rotation"],
    "boundary.right": {"type": "free"},
}


def run_of(case, steps=150, datum=None) -> Simulation:
    kind = Disks()
    scene = kind.build(case)
    simulation = Simulation(scene, kind.choose_step(scene)[0], datum=datum)
    simulation.run(steps)
    return simulation


def test_it_is_the_first_step_and_the_mean_place_inside_a_part_of_the_scene(bar) -> None:
    run = run_of(bar(BONDS))
    cracks = run.system.take_cracks(run.state.step)
    first = cracks.step == cracks.step.min()
    assert 1 < first.sum() < len(cracks)  # a whole section at once, others later

    found = Disks().findings(run.scene, run_of(bar(BONDS)))
    assert found[BREAK_TIME] == (pytest.approx(cracks.step.min() * run.time_step), "s")
    assert found[BREAK_X] == (pytest.approx(cracks.position[first, 0].mean()), "m")
    # the section is whole, so its mean is the middle of the bar, to rounding
    assert found[BREAK_Y] == (pytest.approx(0.5 * run.scene.size[1]), "m")

    end = float(cracks.position[first, 0].max()) - 0.1
    rest = cracks.position[:, 0] < end  # what breaks later, nearer to the driven end
    found = first_break(run_of(bar(BONDS)), (0.0, 0.0, end, 1.0))
    assert found[BREAK_TIME].value == pytest.approx(cracks.step[rest].min() * run.time_step)
    assert found[BREAK_X].value < end
    assert first_break(run_of(bar(BONDS)), (0.0, 0.0, 0.3, 1.0)) == {}


FREE = {**BODY, "output.contacts": True}


def shaken(scene: DiskScene, size: float) -> np.ndarray:
    """Random displacements and rotations (3, n)."""
    return np.random.default_rng(3).normal(0.0, size, (3, scene.count))


def summed(columns: dict[str, np.ndarray], count: int) -> np.ndarray:
    """Forces (2, n) of the contacts on all disks, from the columns alone."""
    first, second = columns["particles"].T
    along = columns["vector"] / np.hypot(*columns["vector"].T)[:, None]
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    force = columns["normal_force"][:, None] * along + columns["shear_force"][:, None] * left
    total = np.zeros((count, 2))
    np.add.at(total, first, force)
    np.add.at(total, second, -force)
    return total.T


def test_tension_is_positive_and_shear_pulls_the_first_disk_to_its_left(bar) -> None:
    along, scene = (0.6, -0.8), build(bar({**FREE, "packing.size": [4.0, 4.0]}))
    pairs = plain_contacts(scene.ground, scene.assembly, scene.layout.slot)
    (k,) = set(pairs.contact_type[:1])
    rows = pairs.constants.copy()
    rows[k, :2] = 0.5 * np.array(along)  # one contact, turned
    rows[k, 6] *= 0.3
    pairs = pairs._replace(constants=rows)
    first, second = scene.assembly.pairs[0]
    normal, shear = rows[k, 5] + rows[k, 7], rows[k, 6] + rows[k, 8]
    apart, aside = 1e-6, 3e-6
    displacement = np.zeros((3, scene.count))
    displacement[:2, second] = apart * np.array(along) + aside * np.array([-along[1], along[0]])
    columns = contact_columns(pieces(scene.layout, pairs, displacement, REFERENCE))
    at = np.flatnonzero((columns["particles"][0] == [first, second]).all(axis=1))[0]

    assert normal > 1.1 * shear > 0.0
    assert columns["normal_force"][0][at] == pytest.approx(normal * apart, rel=1e-12)
    assert columns["shear_force"][0][at] == pytest.approx(shear * aside, rel=1e-12)
    np.testing.assert_array_equal(columns["vector"][0][at], rows[k, :2])
    assert columns["bonded"][0][at]


WITH_HISTORY = {"material.law": "linearpbond", "material.fric": 0.5, "material.contact_share": 0.5}
BRITTLE = {**WITH_HISTORY, "material.pb_ten": 1e6, "material.pb_coh": 1e6}


def broken(bar) -> Simulation:
    """A random packing under the history-dependent law after random velocities have broken some of its bonds."""
    scene = build(bar({**FREE, "packing": DENSE, **BRITTLE, "material.elastic_start": False}))
    simulation = Simulation(scene, choose_step(scene)[0])
    simulation.state.velocity = shaken(scene, 0.4)
    simulation.advance(30)
    return simulation


def test_under_the_law_with_a_history_they_are_those_of_the_last_step(bar) -> None:
    simulation = broken(bar)
    scene, system, displacement = simulation.scene, simulation.system, simulation.state.displacement
    columns = {name: values for name, (values, _) in system.contact_forces(displacement).items()}
    expected = system.forces.last(system.contacts)[:2]
    rounding = 1e-14 * np.abs(columns["normal_force"]).max()
    np.testing.assert_allclose(summed(columns, scene.count), expected, rtol=0.0, atol=10.0 * rounding)

    (contacts,) = system.contacts.values()
    unbonded, states = ~columns["bonded"], contacts.of("state")
    assert np.count_nonzero((states == TENSION) | (states == SHEAR)) > 0
    assert np.count_nonzero(columns["bonded"]) == np.count_nonzero(states == INTACT)
    # what is not bonded is there as it pushes, and slips at half of that; the last step, of 1e-4 s at some 0.4 m/s over
    # 0.4 m, has turned the vector by 1e-4
    assert 0 < np.count_nonzero(unbonded) < len(unbonded)
    assert (columns["normal_force"][unbonded] < 0.0).all()
    turned = 1e-3 * np.abs(columns["normal_force"][unbonded])
    assert (np.abs(columns["shear_force"][unbonded]) <= 0.5 * np.abs(columns["normal_force"][unbonded]) + turned).all()
    counted = np.bincount(columns["particles"].ravel(), minlength=scene.count)
    np.testing.assert_array_equal(counted, system.snapshot(displacement)["coordination"][0])

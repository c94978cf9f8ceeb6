"""What changes at a time of a run does so then, and not before: groups that weaken, holes, supports that let go.

A block of a lattice, bonded to a row of disks that is held, or hanging from one, is set free at a time t₀. It then
slides with a_x − μg, or falls with g, as a rigid body does.
"""

from typing import Any

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.changes import Changes
from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene, build
from dembound.kinds import with_changes
from dembound.motion import memory
from dembound.motion.simulation import Simulation

SIZE, FRICTION, ALONG, GRAVITY = (6.0, 3.0), 0.1, 3.0, 9.81
BRITTLE = {"law": "linearpbond", "fric": 0.5, "pb_ten": 1e7, "pb_coh": 1e7, "dp_nratio": 0.3}
BASE = {"name": "base", "region": [0.0, 0.0, 6.0, 0.5], "fric": FRICTION, "pb_ten": 1.0, "pb_coh": 1.0}
BEGINS = 0.01
"""Time t₀ (s) of the change, when nothing has moved yet."""
DURATION = 0.06
"""Time (s) up to which a block has come less than 0.01 diameters out of the dents of the row below."""


def block(lab, along: float = ALONG, held: str = "bottom", **changes: Any) -> Case:
    """A block under weight and an acceleration along x, held at one side while it settles."""
    sides: dict[str, Any] = {"boundary": {"bottom": "fixed"}} if held == "bottom" else {}
    case = lab.case(
        "A",
        SIZE,
        held=(),
        material=BRITTLE,
        load=[{"acceleration": [along, -GRAVITY]}],
        static={"ratio": 1e-6, "boundary": {held: {"type": "fixed"}}},
        **sides,
    )
    return with_changes(case, changes)


def run(lab, case: Case, duration: float = DURATION) -> tuple[Simulation, Any]:
    """A run of a case up to a time (s), with its ledger."""
    scene = build(case)
    simulation = lab.simulation(scene, settle(scene).start)
    ledger = lab.ledger(simulation, 20)
    simulation.track(Changes(scene, simulation.system, simulation.time_step))
    simulation.run(round(duration / simulation.time_step))
    return simulation, ledger


def upper(scene: DiskScene, height: float) -> np.ndarray:
    """Disks above a height (m)."""
    return np.flatnonzero(scene.positions[:, 1] > height)


def velocity(simulation: Simulation, disks: np.ndarray) -> np.ndarray:
    """Mean velocity (3,) m/s and rad/s of equal disks, half a step ago."""
    return simulation.state.velocity[:, disks].mean(axis=1)


def test_a_weakened_row_lets_the_block_slide_as_a_rigid_one(lab) -> None:
    """Contacts across the border have the weaker limits. The bonds' half of the weight passes to contacts."""
    simulation, ledger = run(lab, block(lab, group=[BASE | {"time": BEGINS}]))
    free = upper(simulation.scene, 0.5)
    since = simulation.time - 0.5 * simulation.time_step - BEGINS
    # the friction of the mean pressure, which still swings: measured 0.6 %; the limits of one side alone give 2.4 times
    # as much friction, or none
    assert velocity(simulation, free)[0] == pytest.approx((ALONG - FRICTION * GRAVITY) * since, rel=0.02)
    last = ledger.entries[-1]
    assert last.friction > 0.0
    assert last.crack > 0.0
    assert abs(last.error) < 1e-6 * last.supplied  # measured 4e-8: normals rotate


@pytest.mark.slow
def test_nothing_changes_before_and_nothing_without_stress(lab) -> None:
    """Until the change, and after it without forces along the weak row, bits are those of a run without the group's."""
    strong = BASE | {"time": BEGINS, "fric": 0.5, "pb_ten": 1e7, "pb_coh": 1e7}
    early = [run(lab, block(lab, group=[each | {"time": BEGINS}]), 0.9 * BEGINS)[0] for each in (BASE, strong)]
    calm = [run(lab, block(lab, 0.0, group=[each]))[0] for each in (BASE | {"time": BEGINS}, strong)]
    for one, other in (early, calm):
        assert np.array_equal(one.state.u, other.state.u)
        assert np.array_equal(one.state.v, other.state.v)


def test_a_row_that_vanishes_lets_the_block_fall(lab) -> None:
    hole = {"name": "row", "type": "rectangle", "corners": [0.0, 0.5, 6.0, 1.0], "stage": "run", "time": BEGINS}
    simulation, ledger = run(lab, block(lab, 0.0, hole=[hole]))
    free = upper(simulation.scene, 1.0)
    since = simulation.time - 0.5 * simulation.time_step - BEGINS
    v = velocity(simulation, free)
    assert v[1] == pytest.approx(-GRAVITY * since, rel=2.0 * simulation.time_step / since)  # it begins at a whole step
    assert abs(v[0]) < 1e-9
    gone = np.setdiff1d(upper(simulation.scene, 0.5), free)
    assert not simulation.state.velocity[:, gone].any()
    last = ledger.entries[-1]
    assert last.damping > 0.0
    assert abs(last.error) < 1e-12 * last.supplied


def test_a_hole_in_motion_takes_its_energy_out_of_the_ledger(lab) -> None:
    """The lower half of a falling and swinging block vanishes: half of its energy of motion, and what it stores."""
    hole = {"name": "half", "type": "rectangle", "corners": [0.0, 0.0, 6.0, 1.5], "stage": "run", "time": 0.03}
    case = block(lab, 0.0, "top", hole=[hole], **{"static.boundary.top.until": BEGINS})
    simulation, ledger = run(lab, case, 0.029)
    step, free = simulation.time_step, upper(simulation.scene, 1.5)
    fallen = simulation.state.velocity[1].mean()  # of the whole, in which halves swing
    assert fallen == pytest.approx(-GRAVITY * (simulation.time - BEGINS), rel=2.0 * step / (simulation.time - BEGINS))
    simulation.run(round(0.03 / step) + 2)  # the hole is made in between
    begun, before = simulation.time, velocity(simulation, free)[1]
    simulation.run(round(DURATION / step))
    later = -GRAVITY * (simulation.time - begun)
    assert velocity(simulation, free)[1] - before == pytest.approx(later, rel=1e-6)  # as near to rest as it had settled
    last = ledger.entries[-1]
    taken = 0.5 * simulation.scene.mass.sum() / 2.0 * fallen**2
    # beside the energy of the mean motion that of the swing, as much as the block was stretched by its weight
    assert last.damping > taken
    assert abs(last.error) < 1e-12 * last.supplied


def test_what_changes_is_the_same_by_any_threads_and_after_a_cut(lab, monkeypatch) -> None:
    hole = {"name": "row", "type": "rectangle", "corners": [2.0, 1.0, 4.0, 1.5], "stage": "run", "time": 1.5 * BEGINS}
    case = block(lab, group=[BASE | {"time": BEGINS}], hole=[hole])
    monkeypatch.setattr(memory, "PARTICLES_PER_THREAD", 1)
    whole, _ = run(lab, case, 2.0 * BEGINS)
    steps = whole.state.step
    for cut in (1.0, 1.2):
        first, _ = run(lab, case, cut * BEGINS)
        second, _ = run(lab, case, 0.0)
        second.state.take(first.state.arrays())
        lab.advanced(second, steps - second.state.step, 2)
        for name in ("u", "v", "work"):
            assert np.array_equal(getattr(second.state, name), getattr(whole.state, name))


def test_springs_of_a_group_are_in_series_with_those_beside_it(lab) -> None:
    """A force F stretches n soft contacts, m stiff ones of twice the modulus, and two across the border, of 4/3."""
    case = lab.case("A", (0.5, 6.0), material={"law": "elastic"})
    group = {"name": "stiff", "region": [0.0, 2.0, 0.5, 4.0], "p_wave_speed": 1000.0 * np.sqrt(2.0)}
    scene = build(with_changes(case, {"group": [group], "motion.held": []}))
    up = np.argsort(scene.positions[:, 1])
    inside = (scene.positions[up, 1] > 2.0) & (scene.positions[up, 1] < 4.0)
    soft = np.array([1.0, 0.75, 0.5])[inside[1:].astype(int) + inside[:-1]]
    moved = np.zeros((3, len(up)))
    moved[1, up] = 1e-6 * np.concatenate([[0.0], np.cumsum(soft)])
    force = lab.forces(scene, moved)[1, up]
    expected = 1e-6 * 2500.0 * 1000.0**2
    np.testing.assert_allclose(force, [expected, *np.zeros(len(up) - 2), -expected], atol=1e-9 * expected)

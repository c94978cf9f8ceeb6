"""Contacts that resist rolling: what rests on a slope, how fast it rolls, what that takes, and the step it allows."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.stability import step_limit
from dembound.kernels.contacts import INTACT
from dembound.motion import memory
from dembound.motion.energy import Entry
from dembound.motion.simulation import Simulation

GRAVITY, RADIUS, FLOOR = 9.81, 0.25, 100.0
ROLLING = 0.3
LOOSE = {"law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.8, "kratio": 2.0, "rr_fric": ROLLING}
REDUCED = FLOOR / (RADIUS + FLOOR)  # R̄ over the radius of the disk
BRITTLE = {"law": "linearpbond", "fric": 0.5, "rr_fric": 0.4, "pb_ten": 4e5, "pb_coh": 6e5}
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
STEPS = 250


MASS = 2500.0 * (2.0 * RADIUS) ** 2
RISE, LATER, END = 0.1, 0.2, 0.3


def rolled(lab, slope: float) -> tuple[Simulation, np.ndarray, Entry]:
    """A disk that lies on one 400 times as large, in gravity that is tilted by a slope, with a ledger.

    Returns the run, velocities (2, 3) at two times after the tilting, and the last entry of the ledger.
    """
    angle, weight = np.arctan(slope), MASS * GRAVITY
    place = (RADIUS, RADIUS)
    scene = lab.disks(
        [[RADIUS, -FLOOR], place],
        [FLOOR, RADIUS],
        held=(),
        material=LOOSE,
        load=[
            {"position": place, "force": (0.0, -weight * np.cos(angle))},
            {"position": place, "force": (weight * np.sin(angle), 0.0), "wave": "pulse"},
        ],
        wave={"type": "constant", "amplitude": 1.0, "rise": RISE},
    )
    simulation = lab.simulation(scene, step=0.1 * step_limit(scene))
    simulation.state.u[1, 1] = -weight * np.cos(angle) / LOOSE["emod"]
    ledger, found = lab.ledger(simulation, 50), []
    for time in (LATER, END):
        simulation.run(round(time / simulation.time_step))
        found.append(simulation.state.velocity[:, 1].copy())
    return simulation, np.array(found), ledger.entries[-1]


@pytest.mark.parametrize("share", [0.95, 1.05, 1.5])
def test_a_disk_rests_below_the_slope_of_its_rolling_resistance_and_rolls_as_in_closed_form_above(lab, share):
    """At rest S = mg sin α and M = SR, so that tan α is rr_fric R̄/R at most; R̄ is nearly R.

    Above it rolls by a = g(sin α − rr_fric R̄/R cos α)/(1 + I/mR²) with I/mR² = ½. On its way s of up to 3 cm the floor
    turns by s/FLOOR = 3e-4, of the excess of 0.05 · 0.3 in the slope 2 %, and half of that in the mean. The moment
    takes rr_fric R̄ N on each radian; while the disk swings on its springs some 1 % less.
    """
    slope = share * ROLLING * REDUCED
    simulation, velocity, last = rolled(lab, slope)
    acceleration = np.diff(velocity, axis=0)[0] / (END - LATER)
    normal = GRAVITY * np.cos(np.arctan(slope))
    if share < 1.0:
        # the load swings the disk on its springs by less than their static displacement, 1e-5 m, at some 100 1/s
        assert np.abs(velocity[:, 0]).max() < 1e-3
        assert last.friction == 0.0
    else:
        assert acceleration[0] == pytest.approx(normal * ROLLING * REDUCED * (share - 1.0) / 1.5, rel=0.01)
        assert acceleration[2] == pytest.approx(-acceleration[0] / RADIUS, rel=0.02)  # swings on its spring
        (contacts,) = simulation.system.contacts.values()
        turned = abs(simulation.state.displacement[2, 1]) - abs(contacts.of("rolled")[0])
        assert last.friction == pytest.approx(ROLLING * REDUCED * RADIUS * MASS * normal * turned, rel=0.02)
    assert abs(last.error) < 1e-9 * last.supplied


def broken(lab, size: tuple[float, float], steps: int, number: int = 1, **material) -> Simulation:
    """A run of grains that pulses break, with so many threads."""
    words = {"held": (), "boundary": SIDES, "wave": lab.pulse(0.01) | {"amplitude": 2.0}, "brick": (4.0, 4.0)}
    return lab.advanced(lab.simulation(lab.scene("B", size, **words, material=BRITTLE | material)), steps, number)


@pytest.mark.parametrize(
    "size", [pytest.param((40.0, 4.0), marks=pytest.mark.slow), (8.0, 4.0)], ids=["rows of copies", "one by one"]
)
def test_broken_ground_has_the_same_bits_by_any_threads_and_after_a_cut_and_the_ledger_closes(lab, size, monkeypatch):
    monkeypatch.setattr(memory, "PARTICLES_PER_THREAD", 1)
    one, cut = (broken(lab, size, 0) for _ in range(2))
    ledger = lab.ledger(one, 50)
    one.run(STEPS)
    two, part = broken(lab, size, STEPS, 2), broken(lab, size, 101)
    cut.state.take(part.state.arrays())
    cut.advance(STEPS - 101)
    (contacts,) = one.system.contacts.values()
    assert (contacts.rows is not None) == (size == (40.0, 4.0))
    intact = contacts.of("state") == INTACT
    assert not contacts.of("rolled")[intact].any()
    assert np.count_nonzero(contacts.of("rolled")[~intact]) > 5
    for other in (two, cut):
        assert np.array_equal(one.state.velocity, other.state.velocity)
        assert np.array_equal(one.state.work, other.state.work)
    last = ledger.entries[-1]
    assert abs(last.error) < 3e-4 * last.supplied


def test_a_settled_heap_stays_at_rest_with_the_moments_of_its_contacts(lab):
    """Loose disks settle under their weight between fixed sides; what has turned them is kept beyond the stage."""
    sides, weight = dict.fromkeys(("left", "right", "bottom"), "fixed"), [{"acceleration": [0.0, -GRAVITY]}]
    static = {"ratio": 1e-8, "boundary": {side: {"type": "fixed"} for side in sides}}
    words = {"held": (), "boundary": sides, "load": weight, "static": static, "brick": (4.0, 4.0)}
    scene = lab.scene("B", (4.0, 4.0), **words, material=LOOSE)
    start = settle(scene).start
    rolled = {name: pairs.of("rolled").copy() for name, pairs in start.contacts.items()}
    simulation = lab.simulation(scene, start)
    simulation.advance(100)
    (contacts,) = simulation.system.contacts.values()
    assert np.abs(rolled["body"]).max() > 0.0
    assert np.array_equal(contacts.of("rolled"), rolled["body"])
    assert not simulation.state.velocity.any()

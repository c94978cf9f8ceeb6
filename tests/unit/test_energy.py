"""The ledger, entry by entry, where each energy is known by hand."""

from dataclasses import fields

import numpy as np
import pytest

from dembound.bar.scene import build_bar
from dembound.energy import GAIN, Entry, Ledger
from dembound.errors import RunError
from dembound.kernels.contacts import REFERENCE, UPDATED, strain_energy
from dembound.scene import build
from dembound.simulate import Simulation, Start
from dembound.stability import choose_step

MASS = 2500.0 * 0.5**2
STEP = 0.01
LONE = {"packing.size": [0.5, 0.5], "monitor": [], "boundary": {}, "wave": {}, "motion.held": []}
FALL = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}]}


def ledger_of(bar, step: float | None = None, **changes: object) -> Ledger:
    scene = build(bar(changes))
    return Ledger(Simulation(scene, step or choose_step(scene)[0], np.zeros(0)))


def test_a_falling_disk_turns_the_work_of_its_weight_into_motion(bar) -> None:
    ledger = ledger_of(bar, STEP, **LONE, **FALL)
    for _ in range(20):
        ledger.step()
    entry = ledger.entries[-1]

    # at step k the velocities half a step before and after are g Δt k and g Δt (k + 1); it fell g Δt² k(k + 1)/2
    work = 0.5 * MASS * (10.0 * STEP) ** 2 * 19 * 20
    assert entry.time == pytest.approx(19 * STEP, rel=1e-15)
    assert entry.kinetic == pytest.approx(work, rel=1e-12)
    assert entry.load == pytest.approx(work, rel=1e-12)
    assert abs(entry.error) < 1e-12 * work
    assert (entry.contact, entry.bond, entry.outside, entry.damping, entry.friction, entry.crack) == (0.0,) * 6


def test_local_damping_takes_its_share(bar) -> None:
    ledger = ledger_of(bar, STEP, **LONE, **FALL, **{"material.damp": 0.3})
    for _ in range(20):
        ledger.step()
    entry = ledger.entries[-1]

    # after its first step, which finds it at rest, it is held back by 0.3 of its weight in every step
    assert abs(entry.error) < 1e-12 * entry.load
    fallen = entry.load / (10.0 * MASS)
    first = 0.5 * 10.0 * STEP**2  # half a step's way at the first velocity is not damped
    assert entry.damping == pytest.approx(0.3 * 10.0 * MASS * (fallen - first), rel=1e-12)


def test_entries_may_be_made_at_any_step(bar) -> None:
    every, some = ledger_of(bar), ledger_of(bar)
    for _ in range(29):
        every.step()
    for pause in (4, 9, 12):
        some.simulation.advance(pause)
        some.step()

    assert np.array_equal(some.columns, every.columns[[4, 14, 27]])


def test_an_entry_hands_on_the_record_of_its_step(bar) -> None:
    scene = build(bar())
    plain, kept = (Simulation(scene, choose_step(scene)[0], np.array([7])) for _ in range(2))
    ledger = Ledger(kept)
    records = [kept.advance(9), ledger.step(), kept.advance(5)]

    assert np.array_equal(np.concatenate(records), plain.advance(15))


def test_columns_stand_in_the_order_of_an_entry(bar) -> None:
    ledger = ledger_of(bar)
    assert ledger.columns.shape == (0, len(fields(Entry)))
    ledger.simulation.advance(10)
    ledger.step()

    assert ledger.columns.tolist() == [[getattr(ledger.entries[0], field.name) for field in fields(Entry)]]


CHAIN = {
    "packing.size": [2.0, 0.5],
    "monitor": [],
    "motion.held": ["y", "rotation"],
    "boundary.right": {"type": "fixed"},
}
PULL = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "wave.pulse.amplitude": -1.0}
BRITTLE = {"material.law": "linearpbond", "material.elastic_start": False, "material.pb_ten": 1e6}


def test_a_chain_that_is_pulled_apart_closes_its_books_with_the_crack(bar) -> None:
    # contacts that only touch let go without force, so all that the step of the crack loses is the bond's energy
    step, rate = 2e-5, 1.0
    ledger = ledger_of(bar, step, **CHAIN, **PULL, **BRITTLE)
    while ledger.simulation.steps < 1000 and (not ledger.entries or ledger.entries[-1].crack == 0.0):
        ledger.step()
    ledger.step()
    *_, last_whole, cracked, after = ledger.entries

    assert last_whole.crack == 0.0 < cracked.crack == after.crack
    # σ = k̄_n u reaches 1 MPa at 0.4 mm, with k̄_n A = 1.25e9 N/m; within a step the pull adds up to 1 m/s · Δt
    assert cracked.crack == pytest.approx(0.5 * 1.25e9 * 4e-4**2, rel=rate * step / 4e-4)
    # before and after, sums of some ten terms a step, each rounded
    assert np.abs(ledger.columns[:, -1]).max() < 10.0 * len(ledger.entries) * np.finfo(float).eps * after.outside


def test_what_was_locked_in_is_no_energy_gained(bar) -> None:
    dense = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
    changes = {"packing": dense, "monitor": [], "wave.pulse.start": 1.0, "motion.held": []}
    ledger = ledger_of(bar, **changes, **BRITTLE)
    for _ in range(3):
        ledger.step()

    assert not ledger.columns[:, 1:].any()


def test_energies_of_a_bar_are_in_springs_and_in_bonds(spalling) -> None:
    ends = {"method.corrected_ends": True, "bar.attenuation": 0.5, "bar.strength": 1e9}
    scene = build_bar(spalling(ends))
    ledger = Ledger(Simulation(scene, choose_step(scene)[0], np.zeros(0)))
    for _ in range(12):
        place, before = ledger.simulation.displacement[0].copy(), ledger.simulation.velocity[0].copy()
        ledger.step()
    entry, bonds = ledger.entries[-1], ledger.simulation.engine.bonds

    stretched = [place[p:] - place[:-p] for p in (1, 2, 3)]
    assert entry.kinetic == pytest.approx(0.5 * np.sum(scene.mass * before * ledger.simulation.velocity[0]), rel=1e-12)
    assert entry.contact == pytest.approx(0.5 * np.sum(bonds.spring * stretched[0] ** 2), rel=1e-12)
    of_bonds = sum(0.5 * np.sum(bonds.bond[p, : 40 - p] * each**2) for p, each in enumerate(stretched))
    assert entry.bond == pytest.approx(of_bonds, rel=1e-12)
    assert min(entry.kinetic, entry.contact, entry.bond, entry.damping, entry.outside) > 0.0
    assert (entry.load, entry.friction, entry.crack, entry.handover) == (0.0,) * 4
    # twelve steps of sums over 41 nodes and 120 bonds
    assert abs(entry.error) < 12 * 41 * np.finfo(float).eps * entry.outside


def at_rest(bar, **changes: object) -> Simulation:
    """A body as built, taken as settled."""
    scene = build(bar(changes))
    contacts = scene.contact_list() if scene.remembers else None
    start = Start(np.zeros((3, scene.count)), contacts, remembers=False)
    return Simulation(scene, choose_step(scene)[0], np.zeros(0), start=start)


def test_what_balances_a_body_works_against_its_weight(bar) -> None:
    # what settled before lets nothing fall: all disks drift along, up or down
    simulation = at_rest(bar, **{**LONE, "packing.size": [1.0, 1.0]}, **FALL)
    ledger = Ledger(simulation)
    simulation.velocity[:2] = [[1.0], [-3.0]]
    for _ in range(10):
        ledger.step()

    for number, entry in enumerate(ledger.entries):
        fallen = 3.0 * number * simulation.time_step
        # four disks; sums of ten steps, each rounded
        assert entry.load == pytest.approx(4.0 * MASS * 10.0 * fallen, rel=1e-13)
        assert entry.balance == pytest.approx(-4.0 * MASS * 10.0 * fallen, rel=1e-13)
        assert entry.kinetic == pytest.approx(0.5 * 4.0 * MASS * 10.0, rel=1e-13)
        # a drift comes with the start
        assert entry.error == pytest.approx(entry.kinetic, rel=1e-13)


PACKED = {
    "packing": {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]},
    "material.law": "linearpbond",
    "material.locked_in": 10e6,
    "material.fric": 0.5,
    "static": {},
    "motion.held": [],
    "boundary": {},
    "wave": {},
    "monitor": [],
}
"""A body of which constant forces keep a pressure of 10 MPa."""


def rigid(simulation: Simulation) -> np.ndarray:
    """Velocities (3, n) of a body that turns about its centre at 1 rad/s."""
    scene = simulation.scene
    x, y = (scene.positions - np.average(scene.positions, axis=0, weights=scene.mass)).T
    return np.stack([-y, x, np.ones(scene.count)])


def test_forces_that_turn_with_a_body_do_what_its_contacts_take(bar) -> None:
    simulation = at_rest(bar, **PACKED, **{"material.elastic_start": False})
    ledger, scene = Ledger(simulation), simulation.scene
    simulation.velocity[:] = 0.5 * rigid(simulation)
    works = [0.0]
    for _ in range(40):
        force, before = simulation.balance.force.copy(), simulation.velocity.copy()
        u = simulation.displacement.copy()
        ledger.step()
        extra = np.zeros_like(force)
        followers = simulation.balance.followers
        extra[:2, followers.node] = followers.extra
        assert (np.abs(extra).max() > 0.0) == (np.abs(u).max() > 0.0)
        half = 0.5 * simulation.time_step * np.sum((force + extra) * before)
        # up to the whole step of the entry; what balances has sums of 60 forces of 1e6 N
        assert ledger.entries[-1].balance == pytest.approx(works[-1] + half, rel=0.0, abs=1e-9)
        works.append(works[-1] + half + 0.5 * simulation.time_step * np.sum((force + extra) * simulation.velocity))

    assert simulation.laws == [("linearpbond", 0)]
    # a constant force would do −½θ²·2pA: what turns does nothing on the whole, but for what stretches the body
    angle = 0.5 * 39 * simulation.time_step
    area = np.prod(scene.size)
    assert abs(ledger.entries[-1].balance) < 0.1 * angle**2 * 10e6 * area
    assert abs(simulation.balance.work(simulation.displacement)) > 0.5 * angle**2 * 10e6 * area


def test_the_jump_of_the_potential_where_the_law_changes_is_its_handover(bar) -> None:
    simulation = at_rest(bar, **PACKED)
    simulation.velocity[:] = rigid(simulation)
    arm = np.stack([rigid(simulation)[1], -rigid(simulation)[0]])
    while len(simulation.laws) == 1:
        there = simulation.displacement.copy()
        assert not simulation.work[:, 4].any()
        simulation.advance(1)
    (_, _), (law, number) = simulation.laws
    force, pairs = simulation.balance.force, simulation.contacts.arrays
    angle = np.sum(scene_inertia(simulation) * there * rigid(simulation)) / np.sum(
        scene_inertia(simulation) * rigid(simulation) ** 2
    )
    (c, s), turned = (np.cos(angle), np.sin(angle)), there.copy()
    stretched = there[:2] - angle * np.stack([-arm[1], arm[0]]) + arm
    turned[:2] = np.array([[c, -s], [s, c]]) @ stretched - arm
    # under the history-dependent law contacts and bonds have what they sheared by along the way
    simulation.contacts.adopt(there)
    before = sum(strain_energy(there, pairs, REFERENCE)) - np.sum(force * there)
    simulation.contacts.adopt(turned)
    after = sum(strain_energy(turned, pairs, UPDATED)) - np.sum(force * turned)

    assert law == "linearpbond"
    assert number == simulation.steps - 1
    assert not np.array_equal(there, simulation.displacement)
    # the step to come counts the turning's work from half a step before, when it did none
    extra = (np.array([[c, -s], [s, c]]) - np.eye(2)) @ force[:2]
    half = 0.5 * simulation.time_step * np.sum(extra * simulation.switch_velocity[:2])
    assert abs(half) > 0.01 * abs(after - before)
    # sides turn as the body does, but for its strain of 1e-2 MPa/E
    assert simulation.work[:, 4].tolist() == pytest.approx([after - before - half] * 2, rel=1e-5)
    # most of it is that the forces have come nearer to the body: (1 − cos θ) Σ F·r, with Σ F·r = −2pA
    assert after - before == pytest.approx((1.0 - c) * np.sum(force[:2] * arm), rel=1e-4)

    ledger_entry = entered(simulation)
    assert ledger_entry.handover == simulation.work[1, 4]


def scene_inertia(simulation: Simulation) -> np.ndarray:
    """Mass, mass and moment of inertia (3, n)."""
    return np.stack([simulation.scene.mass, simulation.scene.mass, simulation.scene.inertia])


def entered(simulation: Simulation) -> Entry:
    """The entry of the next step."""
    ledger = Ledger(simulation)
    ledger.step()
    return ledger.entries[-1]


@pytest.mark.parametrize(("gain", "stops"), [(0.99 * GAIN, False), (1.01 * GAIN, True)])
def test_a_run_that_gains_energy_from_nothing_is_stopped(bar, gain: float, stops: bool) -> None:
    ledger = ledger_of(bar, STEP, **LONE)
    simulation = ledger.simulation
    simulation.velocity[0] = 2.0
    ledger.step()
    came = 0.5 * MASS * 2.0**2
    simulation.velocity[0] *= np.sqrt(1.0 + gain)
    if not stops:
        ledger.step()
        return
    with pytest.raises(RunError, match="has gained") as caught:
        ledger.step()
    message = str(caught.value)
    assert f"has gained {gain * came:.3g} J/m from nothing until t = {STEP:g} s" in message
    assert f"had brought in {came:.3g} J/m at most; take a smaller run.safety or run.time_step" in message


@pytest.mark.parametrize(("gain", "stops"), [(0.99 * GAIN, False), (1.01 * GAIN, True)])
def test_what_loads_bring_in_a_run_may_have(bar, gain: float, stops: bool) -> None:
    ledger = ledger_of(bar, STEP, **LONE, **FALL)
    simulation = ledger.simulation
    for _ in range(11):
        ledger.step()
    assert abs(ledger.entries[-1].error) < 1e-12 * ledger.entries[-1].load
    brought = 10.0 * MASS * -simulation.displacement[1, 0]
    # downwards at w and half a step on at w + g Δt: ½m w (w + g Δt) is what came in and the gain
    simulation.velocity[1] = -(np.sqrt((0.5 * 10.0 * STEP) ** 2 + 2.0 * (1.0 + gain) * brought / MASS) - 5.0 * STEP)
    if not stops:
        ledger.step()
        assert ledger.entries[-1].error == pytest.approx(gain * brought, rel=1e-10)
        return
    with pytest.raises(RunError, match=f"gained {gain * brought:.3g} J/m .* had brought in {brought:.3g} J/m at most"):
        ledger.step()


@pytest.mark.parametrize("law", [{}, {"material.elastic_start": False}], ids=["elastic", "linearpbond"])
def test_rounding_is_no_gain_where_nothing_was_put_in(bar, law: dict) -> None:
    simulation = at_rest(bar, **PACKED, **law)
    ledger = Ledger(simulation)
    simulation.velocity[:] = 1e-12 * np.random.default_rng(1).uniform(-1.0, 1.0, (3, simulation.scene.count))
    first = np.sum(0.5 * scene_inertia(simulation) * simulation.velocity**2)
    for _ in range(200):
        ledger.step()

    # it moves, and sums over contacts that hold 1e4 J round by more than all it was given
    assert max(abs(entry.error - ledger.entries[0].error) for entry in ledger.entries) > GAIN * first


@pytest.mark.parametrize("rate", [1.0, 0.01])
def test_books_of_a_freely_turning_body_stay_closed_where_the_law_changes(bar, rate: float) -> None:
    simulation = at_rest(bar, **PACKED)
    simulation.displacement[:] = 0.0099 * rigid(simulation)  # a little before the turn at which the law ends
    simulation.velocity[:] = rate * rigid(simulation)
    ledger = Ledger(simulation)
    while len(simulation.laws) == 1 or simulation.steps < simulation.laws[-1][1] + 5:
        ledger.step()
    errors = np.array([entry.error for entry in ledger.entries])
    # some 100 J half a step, or the step of the change, may be wrong by; without them what is left is below 1e-2 J
    assert np.abs(errors - errors[0]).max() < 0.1

"""The ledger, entry by entry, where each energy is known by hand."""

from dataclasses import fields

import numpy as np
import pytest

from dembound.bar.scene import build_bar
from dembound.energy import Entry, Ledger
from dembound.scene import build
from dembound.simulate import Simulation
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

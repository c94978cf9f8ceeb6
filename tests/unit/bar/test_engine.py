"""How a bar's engine steps: what it answers, what that costs, and what it tells."""

import numpy as np
import pytest

from dembound.bar.engine import BarEngine
from dembound.bar.scene import build_bar
from dembound.energy import Ledger
from dembound.errors import RunError
from dembound.methods import FiniteDifference
from dembound.simulate import Simulation

EPS = np.finfo(float).eps
UNIT = 0.025 / 1000.0
"""Δx/c, s."""
METHODS = {
    "finite_difference": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "switch": {"type": "switch", "horizon": 3},
    "patch": {"type": "patch", "horizon": 3, "reach": 1},
}


@pytest.fixture(params=METHODS.values(), ids=METHODS.keys())
def method(request) -> dict:
    return request.param


@pytest.fixture
def simulation(spalling):
    """Makes simulations of the spalling bar at a Courant number."""

    def make(courant: float = 0.9, probes: tuple[int, ...] = (), **changes: object) -> Simulation:
        return Simulation(build_bar(spalling(changes)), courant * UNIT, np.array(probes, dtype=np.int64))

    return make


def test_stresses_under_uniform_strain(simulation, method: dict) -> None:
    engine = simulation(method=method).engine
    u = np.zeros((3, 41))
    u[0] = 1e-4 * engine.scene.positions[:, 0]
    inside = slice(4, -4)  # peridynamics has soft ends of three planes

    # E·1e-4; displacements of up to 1e-4 rounded, over elongations of 2.5e-6
    np.testing.assert_allclose(engine.stress(u)[inside], 2.5e5, rtol=40 * 8 * EPS)


def test_energy_is_told_apart_by_springs_and_bonds(simulation) -> None:
    u = np.zeros((3, 41))
    u[0] = 1e-4 * np.linspace(0.0, 1.0, 41)
    corrected = METHODS["peridynamics"] | {"corrected_ends": True}
    stored = [simulation(method=each).engine.stored(u) for each in (*METHODS.values(), corrected)]
    (springs, none), (nothing, bonds), _, _, both = stored

    # ½ Eε² of 1 m³; elongations of 2.5e-6 m are differences of up to 1e-4 m
    assert (springs, sum(both)) == pytest.approx((12.5, 12.5), rel=80 * EPS)
    assert none == nothing == 0.0
    assert 0.0 < both[0] == pytest.approx(12.5 - bonds, rel=1e-9)


def test_a_block_may_be_cut_anywhere(simulation, method: dict) -> None:
    whole, cut = (simulation(probes=(20, 35), method=method) for _ in range(2))
    record = whole.advance(70)
    records = [cut.advance(steps) for steps in (1, 9, 33, 7, 20)]

    assert np.array_equal(np.concatenate(records), record)
    assert np.array_equal(cut.displacement, whole.displacement)
    assert np.array_equal(cut.engine.bonds.spring_broken, whole.engine.bonds.spring_broken)
    assert whole.laws == cut.laws
    assert len(whole.engine.take_cracks(70).step) > 0


def test_laws_are_told_with_the_step_of_the_change(simulation) -> None:
    for kind, name in (("switch", "peridynamics, m = 3"), ("patch", "finite differences and peridynamics, m = 3")):
        run = simulation(method=METHODS[kind])
        run.advance(70)
        (first, zero), (second, step) = run.laws
        assert (first, zero, second) == ("finite differences", 0, name)
        # at that step, not before, some spring has come to 0.9 of the critical stretch
        again = simulation(method=METHODS["finite_difference"])
        limit = 0.9 * 8e6 / 2.5e9 * 0.025
        again.advance(step - 1)
        assert np.diff(again.displacement[0]).max() < limit
        again.advance(1)
        assert np.diff(again.displacement[0]).max() >= limit


def test_breaking_and_changes_of_method_close_the_books(simulation, method: dict) -> None:
    ledger = Ledger(simulation(method=method))
    for _ in range(70):
        ledger.step()
    last = ledger.entries[-1]

    came_in = max(entry.outside for entry in ledger.entries)
    # 70 steps of sums over 41 nodes and 120 bonds
    assert max(abs(entry.error) for entry in ledger.entries) < 70 * 41 * EPS * came_in
    assert last.crack > 1e-6 * came_in
    # bonds of three spacings store another energy than springs in a wave that is not uniform
    assert (abs(last.handover) > 1e-6 * came_in) == (method["type"] in ("switch", "patch"))


def test_finite_differences_answer_once_then_springs_break_by_themselves(simulation, monkeypatch) -> None:
    answers = []
    answer = FiniteDifference.answer
    monkeypatch.setattr(FiniteDifference, "answer", lambda self, *state: answers.append(1) or answer(self, *state))
    # three times the strength and a little, of which three spalls come
    load = {"name": "hit", "pressure": 25e6, "nodes": 3, "wave": "hit"}
    run = simulation(method=METHODS["finite_difference"], load=[load])
    ledger, bonds = Ledger(run), run.engine.bonds
    limit = 8e6 / 2.5e9 * 0.025
    for step in range(70):
        due = (bonds.spring > 0.0) & (np.diff(run.displacement[0]) >= limit)
        ledger.step()
        assert np.array_equal(bonds.spring_broken == step, due)

    assert len(np.unique(bonds.spring_broken)) > 3
    assert len(answers) == 1
    # 70 steps of sums over 41 nodes
    came_in = max(entry.outside for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < 70 * 41 * EPS * came_in
    assert ledger.entries[-1].crack > 1e-6 * came_in
    assert ledger.entries[-1].handover == 0.0


def test_every_break_is_told_once(simulation, method: dict) -> None:
    run = simulation(method=method)
    told = []
    for steps in (30, 10, 1, 1, 1, 7, 20):
        run.advance(steps)
        told.append(run.take_cracks())
        assert run.steps - steps <= told[-1].step.min(initial=run.steps - steps)
        assert told[-1].step.max(initial=0) < run.steps

    assert len(run.take_cracks().step) == 0
    steps, pairs = run.engine.bonds.breaks(0)
    assert len(steps) > 0
    assert np.array_equal(np.concatenate([cracks.step for cracks in told]), steps)
    assert np.array_equal(np.concatenate([cracks.pair for cracks in told]), pairs)
    for cracks in told:
        np.testing.assert_allclose(cracks.position[:, 0], 0.025 * cracks.pair.mean(axis=1), rtol=8 * EPS)
        assert not cracks.shear.any()


def test_bond_updates_count_what_pulls(simulation, method: dict) -> None:
    run = simulation(method=method)
    run.advance(5)

    alive = {"peridynamics": 40 + 39 + 38}.get(method["type"], 40)
    assert run.engine.bond_updates == 5 * alive


def test_a_bar_has_blown_up_when_it_swings_beyond_what_a_step_can_follow(simulation, method: dict) -> None:
    velocity = np.zeros((3, 41))
    velocity[0, 10:31] = (-1.0) ** np.arange(21)  # close to the fastest mode
    velocity[0, 20] *= 1.5
    for courant, where in ((0.5, None), (2.5, 20)):
        engine = simulation(courant, method=method).engine
        assert engine.blown_up(velocity) == where
    # slow motion is sound at any step
    velocity[0] = 1.0
    assert engine.blown_up(velocity) is None


def test_what_breaks_at_an_unstable_step_has_blown_up(simulation, method: dict) -> None:
    velocity = np.zeros((3, 41))
    velocity[0] = 1.0
    velocity[0, 7] = -1.1
    for courant, where in ((0.9, None), (2.5, 7)):
        engine = simulation(courant, method=method).engine
        assert engine.blown_up(0.0 * velocity) is None
        engine.bonds.spring_broken[3] = 1
        engine.bonds.spring[:] = 0.0  # soft enough for any step
        engine.bonds.bond[:] = 0.0
        assert engine.blown_up(velocity) == where


def test_an_unstable_run_is_stopped_and_told_where(simulation) -> None:
    run = simulation(1.05, method=METHODS["finite_difference"], **{"bar.strength": 1e30})
    with pytest.raises(RunError, match=r"grew without bound: at t = .* s near \(.*, 0\) m"):
        run.run(4096)


def test_an_answer_that_the_step_is_too_long_for_ends_the_run(simulation, monkeypatch) -> None:
    run = simulation(0.99, method=METHODS["patch"])
    limit = 0.98 * UNIT
    # no such bonds come about by themselves, as the step serves at every stage that the method names
    monkeypatch.setattr(type(run.scene), "is_stable", lambda scene, bonds, step: step <= limit)
    monkeypatch.setattr(type(run.scene), "stable_step", lambda scene, bonds: limit)
    with pytest.raises(RunError, match=rf"allow a time step of {limit:.6g} s only; take a smaller run.time_step"):
        run.advance(70)


def test_an_engine_serves_to_the_end(simulation) -> None:
    run = simulation(method=METHODS["finite_difference"])
    run.advance(70)

    assert isinstance(run.engine, BarEngine)
    assert not run.engine.ended
    assert run.engine.bonds.spring_broken.max() > 0

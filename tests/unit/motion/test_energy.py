"""The ledger, entry by entry, where each energy is known by hand."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest
import tomli_w
from small_cases import GRAINS, PUSHED, small

from dembound.bar import stability as bar_stability
from dembound.bar.scene import build_bar
from dembound.boundaries.support import Edge
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.errors import RunError
from dembound.kinds import loads
from dembound.motion.energy import GAIN, OPPOSED, Entry, Ledger, opposed
from dembound.motion.sides import _bearers
from dembound.motion.simulation import Simulation
from dembound.motion.state import State
from dembound.motion.trackers import NEVER, Tracker
from dembound.running import plan

MASS = 2500.0 * 0.5**2
STEP = 0.01
LONE = {"packing.size": [0.5, 0.5], "monitor": [], "boundary": {}, "wave": {}, "motion.held": []}
FALL = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}]}


def simulated(bar, step: float | None = None, **changes: object) -> Simulation:
    scene = build(bar(changes))
    return Simulation(scene, step or choose_step(scene)[0], np.array([0]))


def booked(simulation: Simulation, interval: int = 1, last: int = NEVER) -> Ledger:
    """The books of a simulation, by default of every step."""
    ledger = Ledger(simulation, interval, last)
    simulation.track(ledger)
    return ledger


@pytest.mark.parametrize("damp", [0.0, 0.3])
def test_a_falling_disk_turns_the_work_of_its_weight_into_motion(bar, damp: float) -> None:
    simulation = simulated(bar, STEP, **LONE, **FALL, **{"material.damp": damp})
    ledger = booked(simulation)
    simulation.advance(20)
    entry = ledger.entries[-1]

    # after its first step, which finds it at rest, it is held back by a part of its weight in every step, at first on
    # the later half of the way of step 1, of ½g Δt²; undamped, at step k the velocities half a step before and after
    # are g Δt (k − ½) and g Δt (k + ½), and it fell ½g Δt² k²
    fallen = entry.load / (10.0 * MASS)
    assert entry.damping == pytest.approx(damp * 10.0 * MASS * (fallen - 0.25 * 10.0 * STEP**2), rel=1e-12)
    assert entry.time == pytest.approx(19 * STEP, rel=1e-15)
    assert abs(entry.error) < 1e-12 * entry.load
    assert (entry.contact, entry.bond, entry.outside, entry.friction, entry.crack) == (0.0,) * 5
    if damp == 0.0:
        assert entry.load == pytest.approx(0.5 * MASS * (10.0 * 19 * STEP) ** 2, rel=1e-12)
        assert entry.kinetic == pytest.approx(entry.load, rel=1e-12)
        assert entry.stepping == pytest.approx(ledger.entries[0].stepping, rel=1e-12)


class Push(Tracker):
    """Changes the velocities at one step, before the trackers after it see them."""

    name = "push"

    def __init__(self, step: int, velocities: Callable[[State], np.ndarray]) -> None:
        self.due, self.velocities = step, velocities

    def handle(self, simulation: Simulation) -> None:
        simulation.state.velocity = self.velocities(simulation.state)
        self.due = NEVER


@pytest.mark.parametrize(("gain", "stops"), [(0.99 * GAIN, False), (1.01 * GAIN, True)])
def test_a_run_that_gains_energy_from_nothing_is_stopped(bar, gain: float, stops: bool) -> None:
    simulation = simulated(bar, STEP, **LONE)
    simulation.track(Push(2, lambda state: np.sqrt(1.0 + gain) * state.velocity))
    ledger = booked(simulation, 2)
    simulation.state.v[0, simulation.state.layout.slot] = 2.0
    simulation.advance(1)
    came = 0.5 * MASS * 2.0**2
    if not stops:
        simulation.advance(2)
        assert len(ledger.entries) == 2
        return
    with pytest.raises(RunError, match="has gained") as caught:
        simulation.advance(2)
    message = str(caught.value)
    assert f"has gained {gain * came:.3g} J/m without input until t = {2 * STEP:g} s" in message
    assert f"had supplied {came:.3g} J/m at most; take a smaller run.safety or run.time_step" in message


PASSING = {
    "bar": {"length": 1.0, "spacing": 0.01, "density": 2620.0, "wave_speed": 2740.0},
    "method": {"type": "finite_difference"},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous"}},
    "wave": {"pulse": {"type": "triangle", "amplitude": 1.0, "rise": 30e-6, "fall": 61e-6}},
    "run": {"duration": 0.1, "courant": 1.0},
}
"""A pulse of 91 µs that takes 365 µs to leave through the other end, of which nothing returns."""


def test_a_pulse_that_comes_and_goes_between_two_entries_was_supplied() -> None:
    scene = build_bar(loads(tomli_w.dumps(PASSING)))
    simulation = Simulation(scene, bar_stability.choose_step(scene)[0])
    ledger = booked(simulation, 300)  # steps of 3.65 µs: it has left after 125
    simulation.advance(1000)

    # ρcA∫v²dt of a triangle is a third of its length; a kink between two steps leaves swings of part of a step
    pulse = 2620.0 * 2740.0 * scene.case.bar.area * 91e-6 / 3.0
    assert ledger.entries[-1].supplied == pytest.approx(pulse, rel=1e-3)
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-12 * pulse


def test_a_wave_that_begins_just_before_a_half_step_is_not_stopped() -> None:
    """Of v ~ t² a step Δt and 0.01 Δt after its beginning v⁺/4v⁻ is 1.01²/(4 · 0.01²), and 2.01²/(4 · 1.01²) later."""
    push = {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.01, "start": 2.49e-4}}
    side = {"boundary.left": {"type": "velocity", "wave_p": "push"}}
    planned = plan(small(PUSHED, changes=side | {"wave": push, "run.time_step": 1e-4}))  # type: ignore[arg-type]
    simulation = Simulation(planned.stepped, planned.time_step)
    ledger = booked(simulation)
    simulation.advance(8)
    shares = [opposed(vars(entry)).share for entry in ledger.entries]
    assert shares[3] == pytest.approx(2550.0, rel=0.01)
    assert shares[3] > OPPOSED
    assert max(shares[:3] + shares[4:]) < 1.0


@pytest.mark.parametrize(
    ("interval", "last", "steps"),
    [(10, NEVER, [0, 10, 20]), (10, 27, [0, 10, 20, 27]), (40, 4, [0, 4]), (1, NEVER, list(range(29)))],
)
def test_entries_may_be_made_at_any_step(bar, interval: int, last: int, steps: list[int]) -> None:
    each, other = simulated(bar), simulated(bar)
    every, some = booked(each), booked(other, interval, last)
    assert some.columns.shape == (0, len(fields(Entry)))
    record = each.advance(29)
    records = [other.advance(part) for part in (4, 9, 12, 4)]  # wherever the run is cut

    assert np.array_equal(some.columns, every.columns[steps])
    assert [entry.time for entry in some.entries] == [step * other.time_step for step in steps]
    assert some.columns.tolist() == [[getattr(entry, field.name) for field in fields(Entry)] for entry in some.entries]
    for field in ("displacement", "peaks"):
        assert np.array_equal(getattr(other.state, field), getattr(each.state, field))
    assert np.array_equal(np.concatenate(records), record)
    # held motions stay zero, the others do not
    assert [each.state.displacement[axis].any() for axis in (0, 1)] == [True, False]


def edge(side: str, nodes: list[int], diameters: list[float]) -> Edge:
    return Edge(side, np.array(nodes), np.zeros((len(nodes), 2)), np.array(diameters), sum(diameters))


def borne(edges: list[Edge], force: np.ndarray, known: dict | None = None) -> np.ndarray:
    """Forces (s, 2) of every side, of forces (2, n) on nodes."""
    return np.array([(share * force[:, node]).sum(axis=1) for node, share in _bearers(edges, known or {})])


LEFT, BOTTOM = edge("left", [0, 1, 2], [1.0, 2.0, 3.0]), edge("bottom", [2, 3, 4], [3.0, 1.0, 1.0])


def test_a_uniform_stress_is_taken_apart_at_a_corner() -> None:
    stress = np.array([[-3.0, 0.5], [0.5, -7.0]])
    force = np.zeros((2, 5))
    for each, outward in ((LEFT, [-1.0, 0.0]), (BOTTOM, [0.0, -1.0])):
        force[:, each.nodes] += np.outer(stress @ outward, each.diameters)
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force), [[18.0, -3.0], [-2.5, 35.0]], rtol=1e-14)


def test_the_rest_at_a_corner_is_of_the_side_along_whose_normal_it_is() -> None:
    force = np.zeros((2, 5))
    force[:, 2] = [10.0, 20.0]
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force), [[10.0, 0.0], [0.0, 20.0]], rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("recorded", [0.0, 4.0])
def test_known_forces_of_sides_are_taken_apart_as_they_were_put_together(recorded: float) -> None:
    """Also where a side is recorded with another force than acts by it: of the 4 N of node 2 by the left side."""
    left, bottom = np.array([[1.0, 4.0], [0.0, -2.0]]), np.array([[6.0, 0.0], [2.0, 7.0]])
    known = {
        "left": (np.array([0, 2]), left, left),
        "bottom": (np.array([2, 4]), bottom, bottom + np.array([[recorded, 0.0], [0.0, 0.0]])),
    }
    force = np.zeros((2, 5))
    force[:, [0, 2]] += left
    force[:, [2, 4]] += bottom
    force[:, 3] = [0.5, 0.25]  # of a node of one side alone
    # where two forces cancel, here along y, what there is belongs to the side along whose normal it is
    expected = [[5.0, 0.0], [6.5 + recorded, 7.25]]
    np.testing.assert_allclose(borne([LEFT, BOTTOM], force, known), expected, rtol=1e-14)


@pytest.mark.parametrize("cuts", [(40,), (1, 2, 8, 9, 23, 24, 40)])
def test_samples_are_those_of_every_nth_step_however_the_run_is_cut(bar, cuts) -> None:
    scene = build(bar())
    step = choose_step(scene)[0]
    unwatched = Simulation(scene, step)
    assert unwatched.sides is None  # only if it is asked to
    assert unwatched.side_samples.record.shape[1:] == (0, 5)
    every, eighth = (Simulation(scene, step, side_stride=stride) for stride in (1, 8))
    every.run(40)
    steps, samples = [], []
    for cut in cuts:
        eighth.run(cut)
        steps += eighth.side_samples.steps.tolist()
        samples.append(eighth.side_samples.record)
    assert steps == [0, 8, 16, 24, 32]
    assert np.array_equal(np.concatenate(samples), every.side_samples.record[::8])
    assert np.array_equal(eighth.state.side_work, every.state.side_work)
    assert np.any(every.side_samples.record[-1])
    assert np.all(every.state.side_work[:, :, 0].any(axis=1))


def test_the_mean_motion_of_a_side_is_that_by_diameters() -> None:
    scene = build(small(GRAINS))
    sides = Simulation(scene, choose_step(scene)[0], side_stride=1).sides
    datum = np.random.default_rng(5).standard_normal((3, scene.count))
    for name, moved in zip(sides.names, sides.origin(datum), strict=True):
        edge = scene.edges[name]
        np.testing.assert_allclose(moved, np.average(datum[:, edge.nodes], axis=1, weights=edge.diameters), rtol=1e-12)

"""The loop: forces, checks and records."""

import time
from dataclasses import replace

import numba
import numpy as np
import pytest
from small_cases import around

from dembound.boundaries.support import SupportBuilder, Supports
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError, RunError
from dembound.machine import Memory
from dembound.motion import memory
from dembound.motion.memory import PARTICLES_PER_THREAD, thread_count_for, threads_for
from dembound.motion.part import NO_CRACKS, Cracks, joined
from dembound.motion.scene import Between
from dembound.motion.simulation import Simulation
from dembound.motion.stability import TOLERANCE, largest_eigenvalue
from dembound.motion.state import Layout
from dembound.motion.trackers import Clock

MASS = 2500.0 * 0.5**2
STEP = 0.01


def lone_disk(bar, supports: Supports) -> DiskScene:
    """One disk moved by its supports only."""
    scene = build(bar({"packing.size": [0.5, 0.5], "monitor": [], "motion.held": []}))
    return replace(scene, supports=supports)


def one_row(**columns: object) -> Supports:
    """A support of particle 0 in x."""
    builder = SupportBuilder()
    builder.add(np.array([0]), 0, **columns)  # type: ignore[arg-type]
    return builder.table()


@pytest.mark.parametrize("prescribed", [False, True])
def test_supports_and_steady_loads_push_a_disk_by_central_differences(bar, prescribed: bool) -> None:
    """M (v⁺ − v)/Δt = F − C (v⁺ + v)/2 − K u + 2 t; a prescribed motion v = 2 t is integrated exactly by midpoints."""
    columns = {} if prescribed else {"stiffness": 5.0 * MASS, "damping": 0.4 * MASS / STEP}
    drive = 2.0 * (1.0 if prescribed else MASS)
    scene = lone_disk(bar, one_row(drive=drive, signal=lambda times: times, prescribed=prescribed, **columns))
    load = MASS * np.array([[2.0], [-3.0], [0.0]])
    simulation = Simulation(scene, STEP, system=DiskSystem(scene, STEP, load=load))
    simulation.state.v[0, simulation.state.layout.slot[0]] = v = 1.0
    u = 0.0
    for step in range(10):
        v = 2.0 * (step + 0.5) * STEP if prescribed else (0.8 * v + STEP * (2.0 * step * STEP + 2.0 - 5.0 * u)) / 1.2
        u += STEP * v
    simulation.advance(10)

    # ten steps of a few operations; across, 55 = 1 + … + 10 steps' worth of a Δt²
    np.testing.assert_allclose(simulation.state.velocity[:, 0], [v, -0.3, 0.0], rtol=1e-13)
    np.testing.assert_allclose(simulation.state.displacement[:, 0], [u, -55 * 3e-4, 0.0], rtol=1e-13)


def test_all_falls_alike_beside_free_fields(bar) -> None:
    """Dashpots between disks and their columns see no relative motion, from the first step on."""
    falls = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}], "wave": {}, "monitor": [], "motion.held": []}
    scene = build(bar(falls | {"boundary": around("free_field", "left", "right")}))
    record = Simulation(scene, 1e-5, np.arange(scene.count)).advance(20)
    falling = -1e-4 * np.arange(20)[:, None] * np.ones(scene.count)
    np.testing.assert_allclose(record[:, :, 4], falling, rtol=1e-9, atol=1e-18)


def test_motion_that_grows_without_bound_ends_the_run_and_says_when_and_where(bar) -> None:
    scene = build(bar())
    simulation = Simulation(scene, 2.0 * choose_step(scene)[1])
    with pytest.raises(RunError, match=r"grew without bound: at t = [\d.]+ s near \([\d.]+, [\d.]+\) m") as caught:
        simulation.run(100_000)

    # twice the limit multiplies by −7 − √48 = −13.9 each step: 308 decimal powers are gone within 271 steps
    assert simulation.state.step <= 2 * DiskScene.block
    assert f"t = {simulation.time:g} s" in str(caught.value)
    assert caught.value.exit_code == 3


@pytest.mark.parametrize(("axis", "sign"), [(0, -1.0), (1, 1.0)])
def test_a_runaway_node_ends_the_run_whichever_way_it_flies(bar, axis: int, sign: float) -> None:
    scene = build(bar())
    simulation = Simulation(scene, choose_step(scene)[0])
    where, limit = 2, simulation.scene.fastest
    place = axis, simulation.state.layout.slot[where]
    watch, none = simulation.trackers[0], np.zeros((0, 0, 6))
    simulation.state.v[place] = 0.9 * sign * limit
    watch.observe(simulation, none)
    x, y = simulation.scene.positions[where]
    for speed in (1.1 * sign * limit, np.nan):
        simulation.state.v[place] = speed
        with pytest.raises(RunError, match=rf"grew without bound.*near \({x:g}, {y:g}\) m"):
            watch.observe(simulation, none)


NODES, FREE = 60, np.array([1.0, 1.0, 0.0])


def scene() -> tuple[Layout, np.ndarray, np.ndarray]:
    """Slots in another order than the nodes, masses, and a stiffness matrix (2n, 2n) of both displacements."""
    rng = np.random.default_rng(1)
    layout = Layout(np.arange(NODES)[::-1] + 3, NODES + 8)
    root = rng.standard_normal((2 * NODES, 2 * NODES))
    return layout, rng.uniform(1.0, 3.0, NODES), root @ root.T


@pytest.mark.parametrize("held", [0, 25, NODES])
def test_it_is_that_of_the_matrix_without_what_is_held(held: int) -> None:
    layout, mass, stiffness = scene()
    moves = np.ones((3, NODES), dtype=np.bool_)
    moves[:2, :held] = False
    kept = moves[:2].ravel()

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        force[:] = 0.0
        force[:2, layout.slot] = (-stiffness @ layout.gather(u)[:2].ravel() * kept).reshape(2, NODES)

    found = largest_eigenvalue(layout, mass, mass, FREE, moves, fill)
    if held == NODES:  # nothing moves
        assert found == 0.0
        return
    matrix = stiffness / np.tile(mass, 2)[:, None]
    exact = np.linalg.eigvals(matrix[np.ix_(kept, kept)]).real.max()

    rounding = 1e-13  # of 70 to 120 dense eigenvalues, whose matrix is not symmetric
    assert -rounding <= found / exact - 1.0 <= TOLERANCE


def test_a_section_within_another_does_not_count_for_that_one(monkeypatch) -> None:
    """Of times at which sections begin and end, with 2 s and 8 s within others, and 16 s between them."""
    times = iter([0.0, 1.0, 3.0, 7.0, 15.0, 15.0, 31.0, 63.0])
    monkeypatch.setattr(time, "perf_counter", lambda: next(times))
    clock = Clock()
    with clock.of("run"):
        for _ in range(2):
            with clock.of("draw"):
                pass
    with clock.of("run"):
        pass
    assert clock.seconds == {"run": 37.0, "draw": 10.0}


def test_small_scenes_get_one_thread_and_the_allowance_comes_back(monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(numba, "get_num_threads", lambda: 4)
    monkeypatch.setattr(numba, "set_num_threads", asked.append)
    with threads_for(3 * PARTICLES_PER_THREAD - 1):
        assert asked == [2]

    assert asked == [2, 4]
    assert [thread_count_for(n * PARTICLES_PER_THREAD) for n in (0, 1, 3, 9)] == [1, 1, 3, 4]


def test_more_than_is_free_is_refused_with_both_numbers(monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 6e9))
    memory.must_fit(6e9, "packing.size", "7 disks")

    with pytest.raises(CaseError) as refused:
        memory.must_fit(6.1e9, "packing.size", "7 disks")
    said = "packing.size: 7 disks need about 6.1 GB of memory, this machine has 8 GB, 6 GB of it free"
    assert refused.value.problems == [said]
    monkeypatch.setattr(memory, "memory_here", lambda: None)  # unknown
    memory.must_fit(1e30, "packing.size", "7 disks")


def test_cracks_among_some_particles_are_numbered_as_these() -> None:
    pairs = np.array([(4, 7), (2, 4), (7, 9), (2, 9)])
    cracks = Cracks(np.arange(4), pairs, np.arange(8.0).reshape(4, 2), np.array([True, False, False, True]))
    left = cracks.among(np.array([2, 7, 9]))

    assert (left.pair.tolist(), left.step.tolist()) == ([[1, 2], [0, 2]], [2, 3])
    assert (left.position.tolist(), left.shear.tolist()) == ([[4.0, 5.0], [6.0, 7.0]], [False, True])


def test_lists_are_joined_in_the_order_of_their_steps() -> None:
    first, second = (
        Cracks(np.array(steps), np.full((2, 2), name), np.full((2, 2), float(name)), np.array([True, False]))
        for name, steps in ((1, [3, 7]), (2, [3, 5]))
    )
    both = joined([first, NO_CRACKS, second])

    # of one step in the order of the lists
    assert both.step.tolist() == [3, 3, 5, 7]
    assert both.pair.tolist() == [[1, 1], [2, 2], [2, 2], [1, 1]]
    assert both.position.tolist() == [[1.0, 1.0], [2.0, 2.0], [2.0, 2.0], [1.0, 1.0]]
    assert both.shear.tolist() == [True, True, False, False]
    assert len(joined([])) == 0


def test_displacement_and_velocity_are_the_same_sum_over_nodes_with_the_same_bits_for_any_number_of_steps() -> None:
    rng = np.random.default_rng(3)
    share, record = rng.normal(size=(25, 3, 3)), rng.normal(size=(40, 25, 6))
    record[:, :, [2, 5]] = np.nan  # rotations of nodes that have none do not count
    share[:, :, 2] = 0.0
    place, plain = Between(np.zeros(2), np.arange(25), share), np.nan_to_num(record)
    motions = np.stack([plain[..., :3], plain[..., 3:]], axis=1)  # displacements and velocities
    expected = np.einsum("kab,tmkb->tma", share, motions).reshape(40, 6)
    whole = place.motion(record)

    np.testing.assert_allclose(whole, expected, rtol=1e-11)
    for first, last in ((0, 1), (1, 8), (8, 40)):
        assert place.motion(record[first:last]).tobytes() == whole[first:last].tobytes()

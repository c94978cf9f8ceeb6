"""Bonded disks in motion: the law they begin with, the change to the other one, and what balances a settled body."""

import numpy as np
import pytest

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.common import BROKE, DONE, LAW_ENDS, LIST_ENDS
from dembound.kernels.contacts import TENSION
from dembound.motion.state import State

ELASTIC, BONDED = "elastic", "linearpbond"

STEP = 1e-4
EPS = np.finfo(float).eps
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
SIDES = {"free": {}, "free field": FREE_FIELD}
DENSE = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
WITH_HISTORY = {**TOUGH, "material.locked_in": 10e6, "static": {}}
"""Contacts that the locked-in stress keeps closed."""

AT_ONCE = {"material.elastic_start": False}
REFERENCE = {"material.geometry": "reference"}
WEIGHT = {
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
}


@pytest.fixture
def scene(bar):
    """Makes random packings that nothing holds or drives."""

    def make(**changes: object) -> DiskScene:
        bare = {"packing": DENSE, "boundary": {}, "wave": {}, "monitor": [], "motion.held": []}
        return build(bar({**bare, **changes}))

    return make


def shaken(body: DiskScene, size: float, seed: int = 3) -> np.ndarray:
    """Random motions or forces (3, n)."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, body.count))


def begun(system: DiskSystem, datum: np.ndarray | None = None) -> State:
    """The state of a system that has begun at rest at a datum (3, n)."""
    still = np.zeros((3, system.scene.count))
    datum = still if datum is None else datum
    layout = system.scene.layout
    state = State(layout, layout.spread(datum), layout.spread(still), datum, np.zeros((0, 3, 2)), np.zeros(0))
    system.begin(state)
    return state


def forces_of(system: DiskSystem, lists: dict[str, ContactList], displacement: np.ndarray) -> np.ndarray:
    """Forces and moments (3, n) of the history-dependent law at displacements (3, n) reached at rest, seam included."""
    for contacts in lists.values():
        contacts.push(displacement)
    return system.forces.last(lists)


def locked_in_forces(body: DiskScene) -> np.ndarray:
    """Forces and moments (3, n) of a body as built."""
    return forces_of(DiskSystem(body, STEP), contact_lists(body), np.zeros((3, body.count)))


def settled(body: DiskScene, *, has_history: bool, size: float = 1e-6) -> Start:
    """A start somewhere, with contacts as built."""
    return Start(shaken(body, size), contact_lists(body) if body.has_history else {}, has_history)


@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_elastic_forces_are_those_of_the_pairs_without_what_was_locked_in(scene, boundary: dict) -> None:
    body = scene(**WITH_HISTORY, boundary=boundary)
    system, u = DiskSystem(body, STEP), shaken(body, 1e-6)
    lists = system.contacts
    for contacts in lists.values():
        contacts.push(np.zeros_like(u), reference=True)
    locked_in = system.forces.last(lists)
    for contacts in lists.values():
        contacts.start_from_displacements(u)
        contacts.push(u, reference=True)
    total = system.forces.last(lists)

    # sums of some five locked-in forces, of which the difference is taken
    scale = max(np.abs(contacts.force[:, :2]).max() for contacts in lists.values())
    found = system.forces.elastic(u)
    np.testing.assert_allclose(found, total - locked_in, rtol=0.0, atol=20.0 * EPS * scale)
    assert np.abs(found).max() > 1e6 * 20.0 * EPS * scale
    assert [part.name for part in system.parts] == (["column", "body"] if boundary else ["body"])
    assert len(system.ties) == bool(boundary)


def test_a_law_without_history_begins_with_its_loads_alone(scene) -> None:
    pull = {"name": "pull", "force": [2.0, 3.0], "position": [1.0, 1.0]}
    for loads in ([], [pull]):
        body = scene(load=loads)
        system = DiskSystem(body, STEP)
        state = begun(system)

        assert state.laws == [(ELASTIC, 0)]
        assert system.contacts == {}
        assert system.balance is None
        assert system.turning is None
        assert np.array_equal(system.steady, body.steady_load if loads else np.zeros((3, 0)))


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_what_is_locked_in_pushes_a_body_as_built_under_either_law(scene, boundary: dict, at_once: bool) -> None:
    body = scene(**WITH_HISTORY, **(AT_ONCE if at_once else {}), boundary=boundary)
    system = DiskSystem(body, STEP)
    state = begun(system)

    # beside a free field it also comes across the seam, of which the elastic law does not know
    if at_once or boundary:
        assert state.laws == [(BONDED, 0)]
        assert not system.steady.any()  # the pairs push with it themselves
    else:
        assert state.laws == [(ELASTIC, 0)]
        assert np.array_equal(system.steady, locked_in_forces(body))
        assert np.abs(system.steady).max() > 1e5
    assert {part.law_name for part in system.parts} == {state.laws[0][0]}
    assert system.balance is None
    assert not any(part.stops_at_breaks for part in system.parts)


@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_a_settled_body_without_history_is_balanced_under_the_elastic_law(scene, boundary: dict) -> None:
    body = scene(**WEIGHT, boundary=boundary)
    start = settled(body, has_history=False)
    system = DiskSystem(body, STEP, start)
    state = begun(system, start.displacement)
    pushes = system.forces.elastic(start.displacement)

    assert state.laws == [(ELASTIC, 0)]
    assert np.array_equal(system.steady, -pushes)
    assert system.balance is not None
    assert np.array_equal(system.balance.force, -pushes - body.steady_load)
    assert np.abs(pushes).max() > 1e2
    assert system.turning is None
    assert system.balancing_work(start.displacement) == 0.0


def test_what_springs_of_supports_bear_is_balanced_too(scene) -> None:
    body = scene(boundary={"right": {"type": "viscoelastic", "distance": 40.0}})
    start = settled(body, has_history=False)
    system = DiskSystem(body, STEP, start)
    begun(system, start.displacement)
    springs = body.supports.springs_at(start.displacement)

    assert springs.any()
    assert np.array_equal(system.steady, springs - system.forces.elastic(start.displacement))


HISTORIES = {"elastic at first": ({}, False), "at once": (AT_ONCE, False), "gone on from": ({}, True)}


@pytest.mark.parametrize(("changes", "has_history"), HISTORIES.values(), ids=HISTORIES)
def test_a_settled_body_with_a_history_is_balanced_under_the_law_it_begins_with(
    scene, changes: dict, has_history: bool
) -> None:
    body = scene(**{**WITH_HISTORY, **changes, **WEIGHT})
    start = settled(body, has_history=has_history)
    lists = contact_lists(body)
    if not has_history:
        for contacts in lists.values():
            contacts.start_from_displacements(start.displacement)
    system = DiskSystem(body, STEP, start)
    resting = forces_of(system, lists, start.displacement)
    state = begun(system, start.displacement)
    law = BONDED if changes or has_history else ELASTIC
    pushes = resting if law == BONDED else system.forces.elastic(start.displacement)

    assert state.laws == [(law, 0)]
    assert system.contacts == start.contacts
    assert system.balance is not None
    assert np.array_equal(system.balance.force, -resting - body.steady_load)
    # nothing moves: load and balance hold what the law pushes with; sums of some five forces
    np.testing.assert_allclose(system.steady, -pushes, rtol=0.0, atol=10.0 * EPS * np.abs(resting).max())
    assert [part.stops_at_breaks for part in system.parts] == [law == BONDED]


@pytest.mark.parametrize("has_history", [False, True])
def test_nothing_balances_a_body_that_settles(scene, has_history: bool) -> None:
    body = scene(**WITH_HISTORY)
    start, load = settled(body, has_history=has_history), shaken(body, 1.0, 5)
    system = DiskSystem(body, STEP, start, settling=True, load=load)
    state = begun(system, start.displacement)

    assert system.balance is None
    assert state.laws == [(BONDED if has_history else ELASTIC, 0)]
    # the elastic law does not know what is locked in
    assert np.array_equal(system.steady, load if has_history else load + locked_in_forces(body))
    assert not any(part.stops_at_breaks for part in system.parts)


def test_beside_a_free_field_a_body_that_settles_begins_under_the_elastic_law(scene) -> None:
    body = scene(**WITH_HISTORY, boundary=FREE_FIELD)
    system = DiskSystem(body, STEP, settling=True)

    assert begun(system).laws == [(ELASTIC, 0)]
    assert np.array_equal(system.steady, locked_in_forces(body))


def test_other_loads_take_the_place_of_the_old_ones(scene) -> None:
    for changes in ({}, WITH_HISTORY):
        body = scene(**changes)
        system = DiskSystem(body, STEP, settling=True)
        begun(system)
        before = system.steady.copy() if changes else np.zeros((3, body.count))
        for seed in (5, 6):
            load = shaken(body, 1.0, seed)
            system.apply(load)
            # a difference of differences
            np.testing.assert_allclose(
                system.steady, before + load, rtol=0.0, atol=4.0 * EPS * np.abs(before).max() + 4.0 * EPS
            )
            assert system.load is load


@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_where_one_part_leaves_the_elastic_law_all_change_to_the_other(scene, boundary: dict) -> None:
    body = scene(**TOUGH, boundary=boundary)
    system = DiskSystem(body, STEP)
    state = begun(system)
    state.displacement, state.velocity, state.step = shaken(body, 1e-4), shaken(body, 1.0, 4), 7
    expected = contact_lists(body)
    for contacts in expected.values():
        contacts.start_from_displacements(state.displacement - STEP * state.velocity)  # the first push adds this step
    moved, speed = state.displacement.copy(), state.velocity.copy()
    system.react(DONE, 3, state)
    system.react(LIST_ENDS, 3, state)
    assert state.laws == [(ELASTIC, 0)]
    assert state.switch_velocity.shape == (3, 0)
    free = not boundary
    system.react(LAW_ENDS, 3, state)

    assert state.laws == [(ELASTIC, 0), (BONDED, 7)]
    assert {part.law_name for part in system.parts} == {system.law_name} == {BONDED}
    assert np.array_equal(state.switch_velocity, state.velocity)
    assert not system.steady.any()
    # one that nothing holds has really turned by what the law of small displacements took for a turn
    assert np.array_equal(state.displacement, moved) != free
    assert np.array_equal(state.velocity, speed) != free
    if not free:
        for name, contacts in system.contacts.items():
            assert contacts.arrays.shear.any()
            assert np.array_equal(contacts.arrays.shear, expected[name].arrays.shear)


def test_a_law_that_changes_in_good_time_changes_no_force(scene) -> None:
    body = scene(**WITH_HISTORY, **REFERENCE)
    system = DiskSystem(body, STEP)
    state = begun(system)
    state.displacement = shaken(body, 1e-6)
    before = system.steady + system.forces.elastic(state.displacement)
    system.react(LAW_ENDS, 1, state)
    after = system.steady + forces_of(system, system.contacts, state.displacement)

    # sums of some five locked-in forces
    scale = np.abs(system.contacts["body"].force[:, :2]).max()
    np.testing.assert_allclose(after, before, rtol=0.0, atol=20.0 * EPS * scale)


@pytest.mark.parametrize("balanced", [False, True])
def test_energy_that_comes_with_another_law_is_written_down(scene, balanced: bool) -> None:
    body = scene(**{**WITH_HISTORY, **WEIGHT}, boundary={"bottom": {"type": "fixed"}})
    start = settled(body, has_history=False) if balanced else None
    system = DiskSystem(body, STEP, start)
    datum = None if start is None else start.displacement
    state = begun(system, datum)
    state.displacement = state.displacement + shaken(body, 1e-5, 5)
    u, moved = state.displacement.copy(), state.displacement - state.datum

    def stored() -> float:
        """Energy of contacts and bonds less the work of what is steady."""
        steady = body.steady_load + (0.0 if system.balance is None else system.balance.force)
        return sum(system.stored(u)) - float(np.sum(steady * moved))

    before = stored()
    system.react(LAW_ENDS, 1, state)
    for contacts in system.contacts.values():
        contacts.start_from_displacements(u)
    change = stored() - before

    assert np.array_equal(state.displacement, u)
    # differences of the energies of all contacts
    np.testing.assert_allclose(state.work[:, 4], change, rtol=0.0, atol=1e-13 * abs(before))
    assert abs(change) > 1e-9 * abs(before)
    assert not np.delete(state.work, 4, axis=1).any()


@pytest.mark.parametrize(
    ("changes", "balanced", "turns"), [({}, True, True), (REFERENCE, True, False), ({}, False, False)]
)
def test_what_balances_turns_under_a_law_that_follows_the_motion(
    scene, changes: dict, balanced: bool, turns: bool
) -> None:
    body = scene(**WITH_HISTORY, **changes)
    start = settled(body, has_history=False) if balanced else None
    system = DiskSystem(body, STEP, start)
    state = begun(system, None if start is None else start.displacement)
    assert system.turning is None
    system.react(LAW_ENDS, 1, state)

    assert (system.turning is not None) == turns
    if turns:
        assert system.turning is system.balance.followers


def test_only_the_part_whose_list_is_old_lists_its_pairs_anew(scene) -> None:
    body = scene(**TOUGH, boundary=FREE_FIELD)
    system = DiskSystem(body, STEP)
    state = begun(system)
    column, rest = system.parts
    state.u[0, state.layout.slot[rest.nodes][::2]] = 1.01 * rest.contacts.skin
    before = [part.pairs for part in system.parts]
    system.react(LIST_ENDS, 1, state)

    assert column.pairs is before[0]
    assert rest.pairs is not before[1]
    assert not column.contacts.origin.any()
    assert np.array_equal(rest.contacts.origin, state.displacement[:2, rest.nodes])


@pytest.mark.parametrize(("why", "ends"), [(BROKE, True), (LIST_ENDS, True), (DONE, False)])
def test_what_balances_ends_on_what_has_broken_away(scene, why: int, ends: bool) -> None:
    body = scene(**TOUGH)
    for has_history in (True, False):
        start, load = settled(body, has_history=has_history), shaken(body, 1.0, 5)
        system = DiskSystem(body, STEP, start, load=load)
        state = begun(system, start.displacement)
        pairs, loose = system.parts[0].pairs, 0
        broken = (pairs.first == loose) | (pairs.second == loose)
        pairs.state[broken], pairs.cracked[broken], pairs.force[:, broken] = TENSION, 1, 0.0
        force, steady = system.balance.force.copy(), system.steady.copy()
        assert force[:, loose].all()
        system.react(why, 1, state)

        if ends and has_history:  # only the law with a history breaks bonds
            assert not system.balance.force[:, loose].any()
            # what is taken off has been added
            scale = np.abs(force).max()
            np.testing.assert_allclose(system.steady[:, loose], load[:, loose], rtol=0.0, atol=4.0 * EPS * scale)
        else:
            assert np.array_equal(system.balance.force, force)
            assert np.array_equal(system.steady, steady)


def test_a_system_goes_on_from_what_another_remembers(scene) -> None:
    body = scene(**WITH_HISTORY)
    start = settled(body, has_history=False)
    system = DiskSystem(body, STEP, start)
    state = begun(system, start.displacement)
    system.react(LAW_ENDS, 1, state)
    memory = {name: np.array(values) for name, values in system.memory().items()}
    other = DiskSystem(body, STEP)
    begun(other)
    other.recall(memory)
    again = other.memory()

    assert other.law_name == BONDED
    assert other.balance is not None
    assert other.turning is other.balance.followers
    assert all(part.stops_at_breaks for part in other.parts)
    assert again.keys() == memory.keys()
    for name, values in memory.items():
        assert np.array_equal(again[name], values)
    # and it shares nothing with the memory
    other.steady += 1.0
    other.balance.force += 1.0
    assert np.array_equal(memory["steady"], system.steady)
    assert np.array_equal(memory["balance/force"], system.balance.force)
    assert system.balancing_work(state.displacement + 1.0) != other.balancing_work(state.displacement + 1.0)


def test_displacements_of_a_start_lie_row_after_row_in_memory() -> None:
    """As those that are read from a record do: sums of them then have one order of terms."""
    moved = np.arange(12.0).reshape(4, 3).T
    assert not moved.flags.c_contiguous
    assert Start(moved).displacement.flags.c_contiguous
    assert np.array_equal(Start(moved).displacement, moved)

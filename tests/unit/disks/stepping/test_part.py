"""Parts of bonded disks: when their law ends, what they do then, and what ties the column to the body."""

import numpy as np
import pytest

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene, build, column_alone
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels import elastic, loop
from dembound.kernels.bonded import seam_ends_forces
from dembound.kernels.common import BROKE, DONE, LAW_ENDS, LIST_ENDS
from dembound.kernels.contact_measures import slack
from dembound.kernels.contacts import INTACT, SHEAR
from dembound.kernels.tables import Body, Links, Log, Seam, SeamEnds, Supports
from dembound.motion.state import State

ELASTIC, BONDED = "elastic", "linearpbond"

STEP = 1e-4
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
DENSE = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
WITH_HISTORY = {**TOUGH, "material.locked_in": 10e6, "static": {}}
"""Contacts that the locked-in stress keeps closed."""


@pytest.fixture
def scene(bar):
    """Makes random packings that nothing holds or drives."""

    def make(**changes: object) -> DiskScene:
        bare = {"packing": DENSE, "boundary": {}, "wave": {}, "monitor": [], "motion.held": []}
        return build(bar({**bare, **changes}))

    return make


def part_of(body: DiskScene, law: str = ELASTIC) -> DiskPart:
    """The only part of a scene without a column, as built, under a law."""
    (part,) = DiskSystem(body, STEP).parts
    part.uses_history = law == BONDED
    return part


def listed(part: DiskPart) -> ContactList:
    """The pairs of a part with a history."""
    assert part.contacts is not None
    return part.contacts


def forces_of(part: DiskPart, displacement: np.ndarray) -> np.ndarray:
    """Forces and moments (3, n) of the history-dependent law at displacements (3, n) reached at rest."""
    total = np.zeros_like(displacement)
    listed(part).push(displacement)
    listed(part).add_forces(total)
    return total


def advance(
    part: DiskPart, body: DiskScene, steps: int, u: np.ndarray, v: np.ndarray, load: np.ndarray | None = None
) -> tuple[int, int]:
    """Advance u and v (3, n) of a part in place without supports and damping; steps done, and why no more.

    load (3, n) : steady forces and moments. The part has reacted to what happened.
    """
    load = np.zeros((3, body.count)) if load is None else load
    arrays = Body(STEP / body.mass, STEP / body.inertia, np.ones(3), load, 0.0, STEP)
    nobody, nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    drive = np.zeros((steps, 0, 3))
    supports = Supports(nobody, *[nothing] * 5, drive=drive, twin=nobody, follow=nothing)
    log = Log(nobody, np.empty((steps, 0, 6)), nobody, np.zeros((0, 3, 2)), np.zeros(0), np.zeros((2, 7)), np.zeros(1))
    done, why = loop.advance(u, np.zeros_like(u), v, 0, (part.law(),), (), None, arrays, supports, log)
    part.react(int(why), int(done), State(body.layout, u, v, np.zeros_like(u), np.zeros((0, 3, 2)), np.zeros(0)))
    return int(done), int(why)


def shaken(body: DiskScene, size: float) -> np.ndarray:
    """Random motions (3, n)."""
    return size * np.random.default_rng(3).uniform(-1.0, 1.0, (3, body.count))


def test_a_scene_without_history_is_not_watched(scene) -> None:
    body = scene()
    part, u, v = part_of(body), shaken(body, 0.0), shaken(body, 1e3)

    assert part.contacts is None
    assert isinstance(part.law(), Links)
    assert advance(part, body, 5, u, v) == (5, DONE)  # though surfaces have moved by half a metre
    assert np.abs(u).max() > 0.1


def test_the_elastic_law_ends_before_the_step_that_leaves_it(scene) -> None:
    body = scene(**WITH_HISTORY)
    part, u, v = part_of(body), shaken(body, 0.0), shaken(body, 1.0)
    contacts, origin = listed(part), listed(part).origin
    done, why = advance(part, body, 200, u, v)

    assert why == LAW_ENDS
    assert 0 < done < 200
    assert slack(u, contacts.arrays, contacts.limits, False) < 0.0
    assert contacts.origin is origin
    # one step back it was still inside: run again, to just there
    again, u, v = part_of(body), shaken(body, 0.0), shaken(body, 1.0)
    assert advance(again, body, done, u, v) == (done, DONE)
    assert slack(u - STEP * v, contacts.arrays, contacts.limits, False) >= 0.0


@pytest.mark.parametrize("law", [ELASTIC, BONDED])
def test_an_old_list_is_made_anew_and_time_goes_on(scene, law: str) -> None:
    body = scene(**WITH_HISTORY)
    part = part_of(body, law)
    contacts = listed(part)
    u, v = np.zeros((3, body.count)), np.zeros((3, body.count))
    v[0] = 10.0  # all together, so that nothing happens between them: 1 mm a step, the skin is 5 cm
    contacts.cells = contacts.cells._replace(reach=0.0)  # as if the scene were so small that any two might meet
    rest = -forces_of(part, u) if law == BONDED else np.zeros_like(u)
    half = 0.5 * contacts.skin / (10.0 * STEP)
    done, why = advance(part, body, 60, u, v, rest)

    assert done == int(half) + 1
    assert why == LIST_ENDS
    assert part.law_name == law
    assert np.array_equal(contacts.origin, u[:2])
    assert advance(part, body, 10, u, v, rest) == (10, DONE)
    np.testing.assert_allclose(u[0], (done + 10) * 10.0 * STEP, rtol=1e-9)


def test_a_list_that_is_not_old_stays(scene) -> None:
    body = scene(**WITH_HISTORY)
    part, moved = part_of(body), np.zeros((3, body.count))
    arrays, still = listed(part).arrays, np.zeros((3, body.count))

    def react(why: int) -> bool:
        """Whether the part lists its pairs anew."""
        part.react(why, 0, State(body.layout, moved, still, still, np.zeros((0, 3, 2)), np.zeros(0)))
        return listed(part).arrays is not arrays

    # that of another part may be
    moved[0, ::2] = 0.99 * listed(part).skin
    assert not react(LIST_ENDS)
    moved[0, 1::2] = 100.0  # all are carried along
    moved[0, ::2] = 100.0 + 0.99 * listed(part).skin
    assert not react(LIST_ENDS)
    moved[0, ::2] = 100.0 + 1.01 * listed(part).skin
    assert not any(react(why) for why in (DONE, LAW_ENDS, BROKE))
    assert react(LIST_ENDS)


def test_both_laws_move_a_body_alike_as_long_as_nothing_gives_way(scene) -> None:
    # with the normals and arms of the start, for bonds and the contacts beside them
    body = scene(**WITH_HISTORY, **{"material.geometry": "reference"})
    moves, v = [], shaken(body, 1e-4)
    for law in (ELASTIC, BONDED):
        part = part_of(body, law)
        u, locked_in = np.zeros((3, body.count)), np.zeros((3, body.count))
        if law == BONDED:
            locked_in = forces_of(part, u)
            listed(part).start_from_displacements(-STEP * v)  # its first push adds this step
        assert advance(part, body, 50, u, v.copy(), -locked_in) == (50, DONE)
        moves.append(u)

    # locked-in forces of 5 MN are rounded in every step; beside them those of the motion are 1e9 N/m · 1e-4 m/s · Δt
    rounding = 50 * 10.0 * np.finfo(float).eps * 5e6 / (1e9 * 1e-4 * STEP)
    assert np.abs(moves[0] - moves[1]).max() < rounding * np.abs(moves[0]).max()


@pytest.mark.parametrize("stops", [False, True])
def test_a_part_may_stop_after_a_step_that_breaks_bonds(scene, stops: bool) -> None:
    body = scene(**TOUGH, **{"material.pb_ten": 1e6, "material.pb_coh": 1e6})
    part = part_of(body, BONDED)
    part.stops_at_breaks = stops
    u, v = np.zeros((3, body.count)), shaken(body, 1.0)
    done, why = advance(part, body, 40, u, v)
    cracks = part.take_cracks(done)

    assert len(cracks) > 0
    assert (why, done < 40) == ((BROKE, True) if stops else (DONE, False))
    assert set(cracks.step) == {done - 1} if stops else len(set(cracks.step)) > 1
    assert len(part.take_cracks(done)) == 0


@pytest.mark.parametrize("law", [ELASTIC, BONDED])
def test_a_part_beside_another_moves_as_it_would_alone(scene, law: str) -> None:
    beside = scene(**WITH_HISTORY, boundary=FREE_FIELD)
    alone = {"column": column_alone(beside), "body": scene(**WITH_HISTORY)}
    for part in DiskSystem(beside, STEP).parts:
        part.uses_history = law == BONDED
        single, start, speed = part_of(alone[part.name], law), shaken(beside, 1e-5), shaken(beside, 1e-3)
        u, v = start.copy(), speed.copy()
        alone_u, alone_v = (np.ascontiguousarray(values[:, part.nodes]) for values in (start, speed))
        for each in (part, single):
            listed(each).start_from_displacements(start if each is part else alone_u)
        assert advance(part, beside, 20, u, v) == advance(single, alone[part.name], 20, alone_u, alone_v) == (20, DONE)
        others = np.ones(beside.count, dtype=np.bool_)
        others[part.nodes] = False

        assert np.array_equal(u[:, part.nodes], alone_u)
        assert np.array_equal(v[:, part.nodes], alone_v)
        assert not np.array_equal(alone_u, start[:, part.nodes])
        assert np.array_equal(u[:, others], start[:, others])
        assert np.array_equal(v[:, others], speed[:, others])
        assert part.stored(u) == single.stored(alone_u)
        assert min(part.stored(u)) > 0.0
        known, expected = part.snapshot(u), single.snapshot(alone_u)
        assert list(known) == list(expected) == ["coordination"]
        for name in known:
            assert np.array_equal(known[name][0], expected[name][0])


def test_the_energy_of_the_elastic_law_is_that_of_its_own_contacts(scene) -> None:
    plain, watched = scene(), scene(**{"material.law": "linearpbond"})
    u = shaken(plain, 1e-6)

    # the same contacts, in another order
    assert part_of(watched).stored(u) == pytest.approx(part_of(plain).stored(u), rel=1e-13)


def test_a_part_goes_on_from_what_another_remembers(scene) -> None:
    body = scene(**TOUGH, **{"material.pb_ten": 1e6, "material.pb_coh": 1e6})
    part, u, v = part_of(body, BONDED), np.zeros((3, body.count)), shaken(body, 1.0)
    advance(part, body, 20, u, v)
    memory = {name: np.array(values) for name, values in part.memory().items()}
    other = part_of(body)
    other.recall(memory)
    again_u, again_v = u.copy(), v.copy()
    for each, moved, speed in ((part, u, v), (other, again_u, again_v)):
        advance(each, body, 20, moved, speed)

    assert other.law_name == BONDED
    assert np.array_equal(again_u, u)
    assert np.array_equal(again_v, v)
    cracks, again = part.take_cracks(20), other.take_cracks(20)
    assert len(cracks) > 0
    for name in ("step", "pair", "position", "shear"):
        assert np.array_equal(getattr(cracks, name), getattr(again, name))


def test_bonds_and_pushing_contacts_are_known_of_every_disk_under_the_law_with_a_history(scene) -> None:
    body = scene(**WITH_HISTORY)
    part, still = part_of(body, BONDED), np.zeros((3, body.count))
    forces_of(part, still)
    pairs = part.pairs
    pairs.state[pairs.state == INTACT] = SHEAR
    pushing = pairs.force[:2].any(axis=0)
    ends = np.concatenate([pairs.first[pushing], pairs.second[pushing]])

    values, unit = part.snapshot(still)["coordination"]
    assert unit == "1"
    assert 0 < np.count_nonzero(pushing) < len(pushing)
    assert np.array_equal(values, np.bincount(ends, minlength=body.count))


def test_each_law_of_the_column_has_a_seam_of_its_own(scene) -> None:
    system = DiskSystem(scene(**TOUGH, boundary=FREE_FIELD), STEP)
    (tie,), column = system.ties, system.parts[0]

    assert column.name == "column"
    assert np.array_equal(tie.nodes, system.scene.seam.node)
    assert isinstance(tie.bundle(tie.nodes), Seam)
    column.uses_history = True
    assert isinstance(tie.bundle(tie.nodes), SeamEnds)


def test_across_the_seam_both_laws_push_alike_as_long_as_nothing_gives_way(scene) -> None:
    system = DiskSystem(scene(**WITH_HISTORY, boundary=FREE_FIELD), STEP)
    (tie,), contacts, u = system.ties, system.contacts["column"], shaken(system.scene, 1e-6)
    contacts.push(np.zeros_like(u), reference=True)
    locked_in = tie.last_forces(contacts)
    contacts.start_from_displacements(u)
    contacts.push(u, reference=True)
    found = tie.elastic_forces(u)

    # sums of some three locked-in forces, of which the difference is taken
    rounding = 20.0 * np.finfo(float).eps * np.abs(contacts.force[:, :2]).max()
    np.testing.assert_allclose(found, tie.last_forces(contacts) - locked_in, rtol=0.0, atol=rounding)
    assert np.abs(found).max() > 1e6 * rounding


@pytest.mark.parametrize("law", [ELASTIC, BONDED])
def test_rows_of_the_seam_stand_at_its_nodes_among_all_that_are_supported(scene, law: str) -> None:
    system = DiskSystem(scene(**TOUGH, boundary=FREE_FIELD), STEP)
    (tie,), contacts, u = system.ties, system.contacts["column"], shaken(system.scene, 1e-6)
    system.parts[0].uses_history = law == BONDED
    contacts.push(u)
    supported = np.union1d(tie.nodes, np.arange(0, system.scene.count, 3))
    bundle = tie.bundle(supported)
    before = np.random.default_rng(4).uniform(-1.0, 1.0, (len(supported), 3))
    force = before.copy()
    (elastic.seam_forces if law == ELASTIC else seam_ends_forces)(bundle, u, u, force)
    expected = tie.elastic_forces(u) if law == ELASTIC else tie.last_forces(contacts)
    at = np.isin(supported, tie.nodes)

    assert 0 < np.count_nonzero(at) < len(at)
    assert np.array_equal(force[at], before[at] + expected.T)
    assert np.array_equal(force[~at], before[~at])

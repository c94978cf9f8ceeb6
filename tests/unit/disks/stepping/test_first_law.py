"""The law that disks begin with, and the forces that are steady under it."""

import numpy as np
import pytest
from disk_systems import (
    AT_ONCE,
    BONDED,
    ELASTIC,
    EPS,
    FREE_FIELD,
    SIDES,
    STEP,
    WITH_HISTORY,
    begun,
    locked_in_forces,
    settled,
    shaken,
)

from dembound.disks.stepping.system import DiskSystem


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_what_is_locked_in_pushes_a_body_as_built_under_either_law(loose, boundary: dict, at_once: bool) -> None:
    body = loose(**WITH_HISTORY, **(AT_ONCE if at_once else {}), boundary=boundary)
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


@pytest.mark.parametrize("has_history", [False, True])
def test_nothing_balances_a_body_that_settles(loose, has_history: bool) -> None:
    body = loose(**WITH_HISTORY)
    start, load = settled(body, has_history=has_history), shaken(body, 1.0, 5)
    system = DiskSystem(body, STEP, start, settling=True, load=load)
    state = begun(system, start.displacement)

    assert system.balance is None
    assert state.laws == [(BONDED if has_history else ELASTIC, 0)]
    # the elastic law does not know what is locked in
    assert np.array_equal(system.steady, load if has_history else load + locked_in_forces(body))
    assert not any(part.stops_at_breaks for part in system.parts)


def test_beside_a_free_field_a_body_that_settles_begins_under_the_elastic_law(loose) -> None:
    body = loose(**WITH_HISTORY, boundary=FREE_FIELD)
    system = DiskSystem(body, STEP, settling=True)

    assert begun(system).laws == [(ELASTIC, 0)]
    assert np.array_equal(system.steady, locked_in_forces(body))


@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_elastic_forces_are_those_of_the_pairs_without_what_was_locked_in(loose, boundary: dict) -> None:
    body = loose(**WITH_HISTORY, boundary=boundary)
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

"""Bonded disks in motion: the change of law."""

import numpy as np
import pytest
from disk_systems import BONDED, ELASTIC, SIDES, STEP, TOUGH, WEIGHT, WITH_HISTORY, begun, settled, shaken

from dembound.disks.stepping.scene_parts import contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.common import DONE, LAW_ENDS, LIST_ENDS


@pytest.mark.parametrize("balanced", [False, True])
def test_energy_that_comes_with_another_law_is_written_down(loose, balanced: bool) -> None:
    body = loose(**{**WITH_HISTORY, **WEIGHT}, boundary={"bottom": {"type": "fixed"}})
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


@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_where_one_part_leaves_the_elastic_law_all_change_to_the_other(loose, boundary: dict) -> None:
    body = loose(**TOUGH, boundary=boundary)
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

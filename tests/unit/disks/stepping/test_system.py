"""Bonded disks in motion: the change of law."""

import numpy as np
import pytest
from disk_systems import (
    STEP,
    WEIGHT,
    WITH_HISTORY,
    begun,
    settled,
    shaken,
)

from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.common import LAW_ENDS


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

"""Forces inside a body at rest."""

import numpy as np
import pytest
from disk_systems import (
    EPS,
    SIDES,
    STEP,
    WITH_HISTORY,
    shaken,
)

from dembound.disks.stepping.system import DiskSystem


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

"""The lists of pairs beside a free-field column: one of each part, and the contact ends that act across the seam."""

import numpy as np
import pytest
from disk_systems import BODY

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import build
from dembound.disks.stepping.scene_parts import contact_lists
from dembound.kernels.contacts import INTACT

LATTICE = {"pattern": "A", "size": [2.0, 1.0], "radius": 0.25}
HALF = {"right": {"type": "viscous", "half_mass": True}}


def half_cells(bar, **strength: float) -> tuple[ContactList, np.ndarray, np.ndarray]:
    """Four disks by two, those on the right half cells; which pairs are upright, and which of these on the right."""
    material = {"material.law": "linearpbond", "material.geometry": "reference", **strength}
    tables = {**BODY, "packing": LATTICE, "boundary": HALF}
    contacts = contact_lists(build(bar({**tables, **material})))["body"]
    first, second = (contacts.assembly.positions[end, 0] for end in contacts.pairs)
    return contacts, first == second, (first == second) & (first == 1.75)


def sheared(contacts: ContactList, upper: tuple[float, ...], lower: tuple[float, ...] = (0.0, 0.0, 0.0)) -> np.ndarray:
    """The upper row moved by (m, m, rad), and the lower one."""
    high = contacts.assembly.positions[:, 1] > 0.5
    return np.where(high, np.array(upper)[:, None], np.array(lower)[:, None])


@pytest.mark.parametrize(
    ("strength", "upper", "lower"),
    [
        ("material.pb_ten", (0.0, 4e-4, 0.0), (0.0, 0.0, 0.0)),
        ("material.pb_coh", (4e-4, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ("material.pb_ten", (0.0, 0.0, 8e-4), (0.0, 0.0, -8e-4)),
    ],
    ids=["tension", "shear", "bending"],
)
def test_half_bonds_break_under_the_same_stress(bar, strength: str, upper: tuple, lower: tuple) -> None:
    # bonds of 1.25 GPa over 0.5 m: 2.5 GPa per m of stretch or slide, and R̄ = 0.25 m times the turn; 1 MPa at 0.4 mm
    contacts, upright, right = half_cells(bar, **{strength: 1e6})
    contacts.push(0.999 * sheared(contacts, upper, lower))
    assert not (contacts.of("state")[upright] != INTACT).any()
    contacts.push(1.001 * sheared(contacts, upper, lower))

    assert right.any()
    assert np.array_equal(contacts.of("state") != INTACT, upright)

"""Claim: in a chain of unequal disks under a force along it, the stress of every disk is the force over its width.

A disk that is pushed by F from both sides has Σ f l = −F·2R, whatever its neighbours are, and a cell of (2R)².
"""

import numpy as np
import pytest

from dembound.disks.contacts.pairs import plain_contacts
from dembound.disks.stepping.fields import particle_stress
from dembound.disks.stepping.scene_parts import contact_lists
from dembound.kernels.contacts import REFERENCE, UPDATED

RADII = np.array([0.25, 0.1, 0.4, 0.3, 0.15, 0.25])
PUSH = 1e4
"""N per metre of thickness; it shortens no contact by more than 2e-5 of its length."""


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
@pytest.mark.parametrize("turn", [0.0, 0.6])
def test_stress_is_force_over_width(lab, law: str, turn: float) -> None:
    along = np.array([np.cos(turn), np.sin(turn)])
    places = np.cumsum(2.0 * RADII) - RADII
    chain = [(k, k + 1) for k in range(len(RADII) - 1)]
    scene = lab.disks(places[:, None] * along, RADII, chain, held=(), material={"law": law})
    nearer = PUSH / scene.ground.stiffness.normal
    moved = np.concatenate([[0.0], -np.cumsum(nearer)])
    displacement = np.vstack([np.outer(along, moved), np.zeros(len(RADII))])
    # it is in equilibrium but for what pushes at its ends
    assert np.abs(lab.forces(scene, displacement)[:, 1:-1]).max() < 1e-9 * PUSH
    if law == "elastic":
        pairs = plain_contacts(scene.ground, scene.assembly, scene.layout.slot)
    else:
        contacts = contact_lists(scene)["body"]
        contacts.push(displacement)
        pairs = contacts.arrays
    stress = particle_stress(scene, pairs, displacement, REFERENCE if law == "elastic" else UPDATED)[1:-1]

    expected = -PUSH / (2.0 * RADII[1:-1, None]) * [along[0] ** 2, along[1] ** 2, along[0] * along[1]]
    # the elastic law counts ways as at the start: places round by ε of 3 m, disks measure 0.1 m and more. The other
    # one counts them as they are, shorter by what the contacts have come nearer, at most all of it on one disk's side
    error = 1e-13 if law == "elastic" else nearer.max() / RADII.min()
    np.testing.assert_allclose(stress, expected, rtol=0.0, atol=error * np.abs(expected).max())

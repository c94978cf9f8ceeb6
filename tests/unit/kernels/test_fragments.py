"""The pieces of a body, by hand and against scipy's connected components."""

import numpy as np
import pytest
from plain_kernels import random_pairs
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from dembound.kernels.contacts import INTACT, NONE, SHEAR, TENSION
from dembound.kernels.fragments import pieces
from dembound.kernels.tables import Contacts


def outside_largest(contacts: Contacts, begin: int, end: int) -> np.ndarray:
    """Particles begin to end that are not in the largest piece of theirs, (end − begin,) bool."""
    piece = pieces(contacts, begin, end)
    assert piece.shape == (end - begin,)
    return piece != np.argmax(np.bincount(piece))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("begin", "end"), [(0, 60), (7, 51)])
def test_pieces_are_those_of_bonds_and_of_contacts_that_push(seed: int, begin: int, end: int) -> None:
    rng = np.random.default_rng(seed)
    contacts = random_pairs(60, 80)
    contacts.first[:], contacts.second[:] = rng.permuted(np.tile(np.arange(60), (80, 1)), axis=1)[:, :2].T
    contacts.state[:] = rng.choice([INTACT, TENSION, SHEAR, NONE], 80)
    contacts.force[:] = rng.choice([-1e-300, 1.0], (4, 80)) * (rng.random((4, 80)) < 0.2)  # moments hold nothing
    acts = (contacts.state == INTACT) | contacts.force[:2].any(axis=0)
    inside = np.all([(ends >= begin) & (ends < end) for ends in (contacts.first, contacts.second)], axis=0)
    i, j = (ends[acts & inside].astype(int) - begin for ends in (contacts.first, contacts.second))
    count, piece = connected_components(coo_matrix((np.ones(len(i)), (i, j)), shape=(end - begin,) * 2), directed=False)
    # scipy numbers pieces by their first particle, and argmax takes the first of the largest
    largest = np.argmax(np.bincount(piece))

    assert count > 3
    assert np.array_equal(outside_largest(contacts, begin, end), piece != largest)
    assert (piece != largest).any()

"""The pieces of a body, by hand and against scipy's connected components."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from dembound.kernels.contacts import INTACT, NONE, SHEAR, TENSION
from dembound.kernels.fragments import pieces
from dembound.kernels.tables import Contacts


def outside_largest(contacts: Contacts, begin: int, end: int) -> np.ndarray:
    """Particles begin to end that are not in the largest piece of theirs, (end − begin,) bool."""
    piece = pieces(contacts, begin, end)
    return piece != np.argmax(np.bincount(piece))


APART = (TENSION, SHEAR, NONE)


@pytest.fixture
def joined(random_pairs):
    """Makes pairs (i, j) of ten particles with a state each, and those that push in x or y at the numbers given."""

    def make(pairs: list[tuple[int, int]], states: list[int], push_x: tuple = (), push_y: tuple = ()) -> Contacts:
        first, second = np.array(pairs, dtype=np.uint32).T
        contacts = random_pairs(10, len(pairs))._replace(
            first=first, second=second, state=np.array(states, dtype=np.uint8)
        )
        contacts.force[:] = 0.0
        contacts.force[0, list(push_x)] = -1e-300
        contacts.force[1, list(push_y)] = 1.0
        contacts.force[2:] = 1.0  # moments alone hold nothing together
        return contacts

    return make


def outside(contacts: Contacts, begin: int, end: int) -> list[int]:
    """The numbers of the particles from begin to end that are outside the largest piece."""
    found = outside_largest(contacts, begin, end)
    assert found.shape == (end - begin,)
    return (begin + np.flatnonzero(found)).tolist()


def test_bonds_hold_pieces_together(joined) -> None:
    # 0-1-2-3 with the pair in the middle listed last, and 5-4
    contacts = joined([(0, 1), (3, 2), (5, 4), (2, 1)], [INTACT] * 4)
    assert outside(contacts, 0, 6) == [4, 5]


@pytest.mark.parametrize("state", APART)
def test_without_a_bond_only_contacts_that_push_do(joined, state: int) -> None:
    pairs, states = [(0, 1), (1, 2), (2, 3), (3, 4)], [INTACT, state, INTACT, INTACT]
    assert outside(joined(pairs, states), 0, 5) == [0, 1]
    assert outside(joined(pairs, states, push_x=(1,)), 0, 5) == []
    assert outside(joined(pairs, states, push_y=(1,)), 0, 5) == []


def test_of_equally_large_pieces_that_with_the_first_particle_counts(joined) -> None:
    # 1-3, 0-5 and 2-4: that with the first particle has the last one, too
    contacts = joined([(3, 1), (5, 0), (2, 4)], [INTACT] * 3)
    assert outside(contacts, 0, 6) == [1, 2, 3, 4]
    assert outside(contacts, 1, 6) == [2, 4, 5]


def test_the_first_of_particles_that_nothing_joins_counts(joined) -> None:
    contacts = joined([(0, 1)], [TENSION])
    assert outside(contacts, 3, 6) == [4, 5]


def test_particles_before_and_behind_are_no_part_of_it(joined) -> None:
    # from 2 to 7 there are 2-3-4 and 5-6; beyond, 0-1 tie 5 and 6 to 7-8-9
    bonds = [(2, 3), (3, 4), (5, 6), (0, 5), (1, 0), (6, 7), (7, 8), (9, 8)]
    contacts = joined(bonds, [INTACT] * len(bonds))

    assert outside(contacts, 2, 7) == [5, 6]
    assert outside(contacts, 0, 10) == [2, 3, 4]
    assert outside(contacts, 0, 7) == [2, 3, 4]  # 0-1-5-6 are four
    assert outside(contacts, 2, 10) == [2, 3, 4]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("begin", "end"), [(0, 60), (7, 51)])
def test_pieces_are_those_of_the_graph(random_pairs, seed: int, begin: int, end: int) -> None:
    rng = np.random.default_rng(seed)
    contacts = random_pairs(60, 80)
    contacts.first[:], contacts.second[:] = rng.permuted(np.tile(np.arange(60), (80, 1)), axis=1)[:, :2].T
    contacts.state[:] = rng.choice([INTACT, *APART], 80)
    contacts.force[:] = rng.uniform(-1.0, 1.0, (4, 80)) * (rng.random(80) < 0.3)
    acts = (contacts.state == INTACT) | contacts.force[:2].any(axis=0)
    inside = ((contacts.first >= begin) & (contacts.first < end)) & (
        (contacts.second >= begin) & (contacts.second < end)
    )
    i, j = (ends[acts & inside].astype(int) - begin for ends in (contacts.first, contacts.second))
    count, piece = connected_components(coo_matrix((np.ones(len(i)), (i, j)), shape=(end - begin,) * 2), directed=False)
    # scipy numbers pieces by their first particle, and argmax takes the first of the largest
    largest = np.argmax(np.bincount(piece))

    assert count > 3
    assert np.array_equal(outside_largest(contacts, begin, end), piece != largest)
    assert (piece != largest).any()

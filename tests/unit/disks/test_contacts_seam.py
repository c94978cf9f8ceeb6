"""The lists of pairs beside a free-field column: one of each part, and the contact ends that act across the seam."""

import numpy as np
import pytest
from disk_systems import BODY, FREE_FIELD, shaken

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene, build, column_alone
from dembound.disks.stepping.scene_parts import contact_lists
from dembound.kernels.contacts import INTACT, NONE, SHEAR, TENSION
from dembound.motion.part import joined

RANDOM = {"size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
PACKINGS = {
    "A": {"pattern": "A", "size": [2.0, 1.5], "radius": 0.25},
    "A, one disk wide": {"pattern": "A", "size": [0.5, 1.5], "radius": 0.25},
    "B": {"pattern": "B", **RANDOM},
    "B, one brick wide": {"pattern": "B", **RANDOM, "size": [4.0, 4.0]},
    "C": {"pattern": "C", **RANDOM, "edge_radius": 0.26},
}


@pytest.fixture
def scene(bar, in_order):
    """Makes scenes between free-field sides under the law with a history."""

    def make(packing: str = "B", **changes: object) -> DiskScene:
        tables = {**BODY, "packing": PACKINGS[packing], "boundary": FREE_FIELD}
        return in_order(build(bar({**tables, "material.law": "linearpbond", **changes})))

    return make


def both(lists: dict[str, ContactList], name: str) -> np.ndarray:
    """A column of the pairs of column and body."""
    each = [contacts.force if name == "force" else contacts.of(name) for contacts in lists.values()]
    return np.concatenate(each)


def keyed(ground: DiskScene, width: float, first: np.ndarray, second: np.ndarray, vectors: np.ndarray) -> list[tuple]:
    """Pairs (i, j, periods between), the same whichever way round they are listed."""
    images = np.rint((vectors - (ground.positions[second] - ground.positions[first]))[:, 0] / width).astype(int)
    pairs = zip(first.tolist(), second.tolist(), images.tolist(), strict=True)
    return [min((i, j, image), (j, i, -image)) for i, j, image in pairs]


def listed(contacts: ContactList, ground: DiskScene, width: float) -> list[tuple]:
    """All pairs of a list."""
    pairs = contacts.arrays
    return keyed(ground, width, pairs.first, pairs.second, pairs.constants[pairs.contact_type, :2])


def twins_keys(lists: dict[str, ContactList], ground: DiskScene) -> list[tuple]:
    """For each pair the key of its twins in the column."""
    twin, rows = ground.seam.twin, [each.arrays.constants[each.arrays.contact_type, :2] for each in lists.values()]
    ends = (twin[both(lists, name)] for name in ("first", "second"))
    return keyed(ground, ground.seam.width, *ends, np.concatenate(rows))


def copy_column(lists: dict[str, ContactList], column: ContactList, ground: DiskScene, moved: np.ndarray) -> None:
    """Let all pairs take the history of their twins at displacements (3, n)."""
    for contacts in lists.values():
        contacts.copy_twins(column, ground.seam.twin[contacts.nodes], moved)


@pytest.mark.parametrize("packing", PACKINGS)
def test_every_pair_takes_the_history_of_its_twin_in_the_column(scene, in_order, packing: str) -> None:
    ground, rng = scene(packing), np.random.default_rng(2)
    bare = in_order(column_alone(ground))
    column, lists = contact_lists(bare)["body"], contact_lists(ground)
    alone = shaken(bare, 0.0 if packing.startswith("A") else 0.2)
    column.search(alone)
    pairs = column.arrays
    bonded = pairs.state == INTACT
    pairs.state[bonded] = rng.choice([INTACT, TENSION, SHEAR], np.count_nonzero(bonded))
    pairs.shear[:], pairs.slip[:] = rng.uniform(-1.0, 1.0, (2, len(pairs.state)))
    together = alone[:, ground.seam.twin]
    copy_column(lists, column, ground, together)

    history = list(zip(pairs.state.tolist(), pairs.shear.tolist(), pairs.slip.tolist(), strict=True))
    expected = dict(zip(listed(column, bare, ground.seam.width), history, strict=True))
    assert len(expected) == len(history)
    keys, state = twins_keys(lists, ground), both(lists, "state")
    found = list(zip(state.tolist(), both(lists, "shear").tolist(), both(lists, "slip").tolist(), strict=True))
    assert [expected[key] for key in keys] == found
    for contacts in lists.values():
        assert np.array_equal(contacts.origin, together[:2, contacts.nodes])
    # pairs of column and body, and in the column some across its period
    in_column = both(lists, "first") < ground.seam.count
    assert 0 < np.count_nonzero(in_column) < len(found)
    assert {key for key, inside in zip(keys, in_column, strict=True) if inside} == set(expected)
    assert any(key[2] for key in expected)
    if not packing.startswith("A"):  # and some that were found since
        assert np.count_nonzero(state[in_column] == NONE) > 0
        assert np.count_nonzero(state[~in_column] == NONE) > 0


def test_what_broke_in_the_column_is_noted_as_broken_before_the_first_step(scene) -> None:
    ground = scene("B")
    column, lists = contact_lists(column_alone(ground))["body"], contact_lists(ground)
    pairs = column.arrays
    pairs.state[np.flatnonzero(pairs.state == INTACT)[:6]] = [TENSION, SHEAR, SHEAR] * 2
    column.arrays.cracked[:6] = 5
    together = shaken(ground, 0.01)[:, ground.seam.twin]
    copy_column(lists, column, ground, together)
    first, second, state = (both(lists, name) for name in ("first", "second", "state"))
    cracks = joined([contacts.take_cracks() for contacts in lists.values()])
    broken = np.flatnonzero((state == TENSION) | (state == SHEAR))

    # each of the column, and its twins in the body; two bricks side by side have those within a brick twice
    assert len(cracks) == len(broken) > 2 * 6
    assert sorted(map(tuple, cracks.pair.tolist())) == sorted(
        zip(first[broken].tolist(), second[broken].tolist(), strict=True)
    )
    assert set(cracks.step) == {0}
    assert np.count_nonzero(cracks.shear) == np.count_nonzero(state == SHEAR)
    assert (both(lists, "cracked") == -1).all()
    assert sum(len(contacts.take_cracks()) for contacts in lists.values()) == 0
    # where the bonds of the body are now; those across the column's period lie at its sides
    inside = cracks.pair[:, 0] >= ground.seam.count
    places = (ground.positions + together[:2].T)[cracks.pair].mean(axis=1)
    np.testing.assert_allclose(cracks.position[inside], places[inside], rtol=0.0, atol=1e-14 * 8.0)


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

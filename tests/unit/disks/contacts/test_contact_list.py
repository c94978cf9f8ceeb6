"""The list of pairs: complete, each pair once, with a history that every search keeps; bonds of half cells."""

from collections import Counter

import numpy as np
import pytest
from disk_systems import BODY, TWO_BRICKS, WRAP

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.scene_parts import contact_lists
from dembound.kernels.contacts import INTACT, NONE, SHEAR, TENSION, note_places
from dembound.kernels.tables import Contacts

SIDES = {"periodic sideways": {side: WRAP[side] for side in ("left", "right")}, "periodic": WRAP}
Key = tuple[int, int, int, int]


@pytest.fixture
def scene(bar, in_order):
    """Makes scenes of the history-dependent law: a random packing, or changed."""

    def make(sides: str = "periodic sideways", **changes: object) -> DiskScene:
        tables = {**BODY, "packing": TWO_BRICKS, "boundary": SIDES[sides]}
        return in_order(build(bar({**tables, "material.law": "linearpbond", **changes})))

    return make


def list_of(body: DiskScene) -> ContactList:
    """The pairs of a scene without a column."""
    (pairs,) = contact_lists(body).values()
    return pairs


@pytest.fixture(params=SIDES)
def contacts(scene, request) -> ContactList:
    return list_of(scene(request.param))


def ordered(i: int, j: int, image: np.ndarray) -> Key:
    """A pair and the periods between, the same whichever way round it is listed."""
    there, back = (i, j, *image), (j, i, *-np.asarray(image))
    return tuple(int(number) for number in min(there, back))


def listed_in(contacts: ContactList) -> Contacts:
    """The pairs without spare places."""
    names = ("first", "second", "contact_type", "state", "shear", "slip", "closed", "cracked", "place")
    return contacts.arrays._replace(**{name: contacts.of(name) for name in names})


def keys(contacts: ContactList) -> list[Key]:
    """All listed pairs, with images recognised by the vectors they started with."""
    pairs, places = listed_in(contacts), contacts.assembly.positions
    beyond = pairs.constants[pairs.contact_type, :2] - (places[pairs.second] - places[pairs.first])
    images = np.rint(beyond / contacts.assembly.size).astype(int)
    # vectors are those of the brick or differences of places
    np.testing.assert_allclose(beyond, images * contacts.assembly.size, atol=1e-12)
    return [ordered(i, j, image) for i, j, image in zip(pairs.first, pairs.second, images, strict=True)]


def near(contacts: ContactList, displacement: np.ndarray) -> set[Key]:
    """Pairs with gaps up to the skin, found by trying all."""
    here, radii = contacts.assembly.positions + displacement[:2].T, contacts.assembly.radii
    found = set()
    steps = [(-1, 0, 1) if period else (0,) for period in contacts.periods]
    for image in ((x, y) for x in steps[0] for y in steps[1]):
        shift = np.array(image) * [period or 0.0 for period in contacts.periods]
        apart = np.hypot(*(here[None] + shift - here[:, None]).transpose(2, 0, 1)) - radii - radii[:, None]
        for i, j in zip(*np.nonzero(apart <= contacts.skin), strict=True):
            if i != j or any(image):
                found.add(ordered(i, j, np.array(image)))
    return found


def shaken(contacts: ContactList, size: float, seed: int = 1) -> np.ndarray:
    """A random motion (3, n) m of all particles."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, len(contacts.assembly.radii)))


def test_after_a_search_near_pairs_and_bonds_are_listed_and_no_others(contacts: ContactList) -> None:
    before = keys(contacts)
    bonded = {key for key, state in zip(before, contacts.of("state"), strict=True) if state == INTACT}
    moved = shaken(contacts, 0.2)
    contacts.search(moved)
    listed = Counter(keys(contacts))

    assert set(listed.values()) == {1}
    assert set(listed) == bonded | near(contacts, moved)
    # there was something to find and, but for the bonds, to forget
    assert set(listed) - set(before)
    assert set(before) - set(listed)
    assert np.array_equal(contacts.origin, moved[:2])


def test_pairs_that_stay_keep_their_memory_and_new_ones_have_none(contacts: ContactList) -> None:
    pairs, count = contacts.arrays, len(contacts.arrays.first)
    pairs.state[::5] = TENSION
    pairs.shear[:], pairs.slip[:] = np.arange(count) + 1.0, -np.arange(count) - 1.0

    def history() -> dict[Key, tuple]:
        listed = listed_in(contacts)
        rows = np.abs(listed.constants[listed.contact_type])
        each = zip(listed.state, listed.shear, listed.slip, *rows.T, strict=True)
        return dict(zip(keys(contacts), each, strict=True))

    before = history()
    for seed in (1, 2):
        contacts.search(shaken(contacts, 0.1, seed))
        for key, found in history().items():
            if key in before and found[1] != 0.0:  # not lost and found again
                assert found == before[key]
            else:
                assert found[:3] == (NONE, 0.0, 0.0)
    assert np.count_nonzero(contacts.arrays.shear) >= np.count_nonzero(pairs.state == INTACT)
    assert np.any(contacts.arrays.shear == 0.0)


def test_cracks_are_reported_once_and_in_the_order_they_happened(scene) -> None:
    contacts = list_of(scene())
    pairs, moved = contacts.arrays, {step: shaken(contacts, 0.01, step) for step in (7, 9, 12)}
    chosen = np.flatnonzero(pairs.state == INTACT)[[40, 3, 20]]
    pairs.cracked[chosen], pairs.state[chosen] = [7, 9, 7], [SHEAR, TENSION, TENSION]
    expected = np.column_stack([pairs.first[chosen], pairs.second[chosen]])[[2, 0, 1]].astype(np.int64)
    for step in (7, 9):
        note_places(moved[step], step, pairs)
    middles = [
        moved[step][:2, [pairs.first[c], pairs.second[c]]].mean(axis=1)
        for c, step in zip(chosen, (7, 9, 7), strict=True)
    ]
    np.testing.assert_allclose(pairs.place[chosen], middles, rtol=1e-12)
    contacts.note_cracks()
    late = np.flatnonzero(pairs.state == INTACT)[0]
    pairs.cracked[late], pairs.state[late] = 12, SHEAR
    note_places(moved[12], 12, pairs)
    contacts.search(shaken(contacts, 0.01, 13))  # must not lose it
    cracks = contacts.take_cracks()

    assert cracks.step.tolist() == [7, 7, 9, 12]
    assert np.array_equal(cracks.pair[:3], expected)
    assert cracks.shear.tolist() == [False, True, False, True]
    assert len(contacts.take_cracks()) == 0


def test_what_is_left_of_a_body_remembers_all_it_went_through(scene) -> None:
    contacts = list_of(scene("periodic"))
    moved = shaken(contacts, 0.02)
    contacts.search(moved)
    old, random = contacts.arrays, np.random.default_rng(2)
    old.shear[:], old.slip[:] = random.uniform(-1e-3, 1e-3, (2, len(old.shear)))
    old.state[random.random(len(old.state)) < 0.2] = SHEAR
    old.closed[:] = random.random(len(old.closed)) < 0.2
    old.cracked[3] = 7
    tunnel = {"name": "tunnel", "type": "circle", "centre": [4.0, 2.0], "radius": 1.0}
    hollow = scene("periodic", hole=[tunnel])
    kept = np.flatnonzero((contacts.assembly.positions[:, None] == hollow.assembly.positions).all(axis=2).any(axis=1))
    left = list_of(hollow)
    left.take_over_subset(contacts, kept)

    old = listed_in(contacts)
    among = np.isin(np.column_stack([old.first, old.second]), kept).all(axis=1)
    new = listed_in(left)
    assert 0 < np.count_nonzero(among) < len(among)
    for before, after in ((old.first[among], kept[new.first]), (old.second[among], kept[new.second])):
        assert np.array_equal(before, after)
    for name in ("state", "shear", "slip", "closed", "cracked"):
        assert np.array_equal(getattr(old, name)[among], getattr(new, name))
    assert np.array_equal(left.origin, moved[:2, kept])
    # the same pairs, so the same forces, across periodic sides as well
    contacts.push(moved)
    left.push(moved[:, kept])
    assert np.array_equal(contacts.force[among], left.force)


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

"""The list of pairs beside a free-field column: two bodies, and the contact ends that act across the seam."""

import numpy as np
import pytest

from dembound.contacts import ContactList
from dembound.kernels.contacts import INTACT, NONE, SHEAR, TENSION
from dembound.scene import Scene, build, column_alone

FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
RANDOM = {"size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
PACKINGS = {
    "A": {"pattern": "A", "size": [2.0, 1.5], "radius": 0.25},
    "A, one disk wide": {"pattern": "A", "size": [0.5, 1.5], "radius": 0.25},
    "B": {"pattern": "B", **RANDOM},
    "B, one brick wide": {"pattern": "B", **RANDOM, "size": [4.0, 4.0]},
    "C": {"pattern": "C", **RANDOM, "edge_radius": 0.26},
}


@pytest.fixture
def scene(bar):
    """Makes scenes between free-field sides under the law with a memory."""

    def make(packing: str = "B", **changes: object) -> Scene:
        tables = {"packing": PACKINGS[packing], "boundary": FREE_FIELD, "wave": {}, "monitor": [], "motion.held": []}
        return build(bar({**tables, "material.law": "linearpbond", **changes}))

    return make


@pytest.fixture(params=PACKINGS)
def contacts(scene, request) -> ContactList:
    return scene(request.param).contact_list()


def shaken(contacts: ContactList, size: float, seed: int = 1) -> np.ndarray:
    """A random motion (3, n) m of all particles."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, len(contacts.assembly.radii)))


def check_ends(contacts: ContactList) -> None:
    """Every end is the twin's, at a pair with the neighbour that the seam names, along the brick's own vector."""
    seam, pairs, ends = contacts.seam, contacts.arrays, contacts.seam_ends()
    twin, pair, side = np.repeat(seam.twin[seam.node], seam.many), ends >> 1, ends & 1
    both = np.stack([pairs.first, pairs.second])[:, pair].astype(np.int64)
    column = np.arange(len(ends))

    assert len(ends) == len(seam.near)
    assert np.array_equal(both[side, column], twin)
    assert np.array_equal(both[1 - side, column], seam.near)
    outward = np.where(side, -1.0, 1.0)[:, None] * pairs.palette[pairs.kind[pair], :2]
    brick = contacts.ground.brick
    expected = np.where(seam.second, -1.0, 1.0)[:, None] * np.tile(brick.vectors, (2, 1))[seam.kind]
    assert np.array_equal(outward, expected)


def test_the_seams_ends_are_those_of_the_columns_pairs(contacts: ContactList) -> None:
    check_ends(contacts)


def test_a_search_moves_the_ends_and_keeps_them_right(contacts: ContactList) -> None:
    contacts.arrays.state[::2] = TENSION  # so that pairs go as well as come
    moved = shaken(contacts, 0.3)
    contacts.search(moved)

    assert np.array_equal(contacts.origin, moved[:2])
    check_ends(contacts)


def test_a_broken_pair_across_the_seam_stays_listed_however_far_apart(scene) -> None:
    contacts = scene().contact_list()
    across = contacts.seam_ends() >> 1
    contacts.arrays.state[across] = TENSION
    apart = np.zeros((3, len(contacts.assembly.radii)))
    apart[0] = 5.0 * contacts.assembly.positions[:, 0]
    contacts.search(apart)

    check_ends(contacts)
    assert set(contacts.arrays.state[contacts.seam_ends() >> 1]) == {TENSION}


def plain_near(contacts: ContactList, body: slice, period: float, displacement: np.ndarray) -> set[tuple[int, ...]]:
    """Pairs of a part of the disks within the skin, at times a period apart, found by trying all: (i, j, periods)."""
    here, radii = (contacts.assembly.positions + displacement[:2].T)[body], contacts.assembly.radii[body]
    found = set()
    for image in (-1, 0, 1) if period else (0,):
        apart = np.hypot(*(here[None] + [image * period, 0.0] - here[:, None]).transpose(2, 0, 1))
        for i, j in zip(*np.nonzero(apart - radii - radii[:, None] <= contacts.skin), strict=True):
            if i != j or image:
                there, back = (i + body.start, j + body.start, image), (j + body.start, i + body.start, -image)
                found.add(tuple(int(number) for number in min(there, back)))
    return found


def listed(contacts: ContactList, width: float) -> list[tuple[int, ...]]:
    """All pairs (i, j, periods) as `plain_near` has them."""
    pairs, places = contacts.arrays, contacts.assembly.positions
    beyond = pairs.palette[pairs.kind, :2] - (places[pairs.second] - places[pairs.first])
    images = np.rint(beyond[:, 0] / width)
    return [
        tuple(int(number) for number in min((i, j, image), (j, i, -image)))
        for i, j, image in zip(pairs.first.astype(int), pairs.second.astype(int), images, strict=True)
    ]


@pytest.mark.parametrize("size", [0.0, 0.2])
def test_the_column_meets_itself_sideways_the_body_does_not_and_they_never_meet(scene, size: float) -> None:
    contacts = scene().contact_list()
    seam, count = contacts.seam, len(contacts.assembly.radii)
    bonded = {key for key, state in zip(listed(contacts, seam.width), contacts.arrays.state, strict=True) if state}
    moved = shaken(contacts, size)
    contacts.search(moved)
    found = listed(contacts, seam.width)
    column = plain_near(contacts, slice(0, seam.count), seam.width, moved)
    body = plain_near(contacts, slice(seam.count, count), 0.0, moved)

    assert len(set(found)) == len(found)
    assert set(found) == column | body | bonded
    assert any(key[2] for key in found)
    for i, j, image in found:
        assert (i < seam.count) == (j < seam.count)
        assert not image or i < seam.count


def test_what_comes_across_the_seam_is_what_the_twins_feel_there(scene) -> None:
    contacts = scene().contact_list()
    moved = shaken(contacts, 1e-3)
    total = contacts.forces(moved)
    pairs, seam = contacts.arrays, contacts.seam
    expected = np.zeros_like(total)
    for i, j, (fx, fy, moment_i, moment_j) in zip(pairs.first, pairs.second, pairs.force, strict=True):
        expected[:, i] += [fx, fy, moment_i]
        expected[:, j] += [-fx, -fy, moment_j]
    owner = np.repeat(seam.node, seam.many)
    for node, end in zip(owner, contacts.seam_ends(), strict=True):
        fx, fy, *moments = pairs.force[end >> 1]
        sign = -1.0 if end & 1 else 1.0
        expected[:, node] += [sign * fx, sign * fy, moments[end & 1]]

    # sums of some five forces, in another order
    np.testing.assert_allclose(total, expected, rtol=0.0, atol=10.0 * np.finfo(float).eps * np.abs(pairs.force).max())


def test_without_a_column_there_are_no_ends(scene) -> None:
    assert len(scene(boundary={}).contact_list().seam_ends()) == 0


def twins_keys(contacts: ContactList) -> list[tuple[int, ...]]:
    """Of each pair (i, j, periods) of its twin in the column, as `plain_near` has them."""
    pairs, places, twin = contacts.arrays, contacts.assembly.positions, contacts.seam.twin
    first, second = twin[pairs.first], twin[pairs.second]
    beyond = pairs.palette[pairs.kind, :2] - (places[second] - places[first])
    images = np.rint(beyond[:, 0] / contacts.seam.width)
    return [
        tuple(int(number) for number in min((i, j, image), (j, i, -image)))
        for i, j, image in zip(first, second, images, strict=True)
    ]


@pytest.mark.parametrize("packing", PACKINGS)
def test_every_pair_takes_the_history_of_its_twin_in_the_column(scene, packing: str) -> None:
    ground, rng = scene(packing), np.random.default_rng(2)
    column, contacts = column_alone(ground).contact_list(), ground.contact_list()
    alone = shaken(column, 0.0 if packing.startswith("A") else 0.2)
    column.search(alone)
    pairs = column.arrays
    bonded = pairs.state == INTACT
    pairs.state[bonded] = rng.choice([INTACT, TENSION, SHEAR], np.count_nonzero(bonded))
    pairs.shear[:], pairs.slip[:] = rng.uniform(-1.0, 1.0, (2, len(pairs.state)))
    together = alone[:, ground.seam.twin]
    contacts.copy_column(column, together)

    history = list(zip(pairs.state.tolist(), pairs.shear.tolist(), pairs.slip.tolist(), strict=True))
    expected = dict(zip(listed(column, ground.seam.width), history, strict=True))
    assert len(expected) == len(history)
    ours, keys = contacts.arrays, twins_keys(contacts)
    found = list(zip(ours.state.tolist(), ours.shear.tolist(), ours.slip.tolist(), strict=True))
    assert [expected[key] for key in keys] == found
    assert np.array_equal(contacts.origin, together[:2])
    # pairs of column and body, and in the column some across its period
    in_column = ours.first < ground.seam.count
    assert 0 < np.count_nonzero(in_column) < len(found)
    assert {key for key, inside in zip(keys, in_column, strict=True) if inside} == set(expected)
    assert any(key[2] for key in expected)
    if not packing.startswith("A"):  # and some that were found since
        assert np.count_nonzero(ours.state[in_column] == NONE) > 0
        assert np.count_nonzero(ours.state[~in_column] == NONE) > 0


def test_what_broke_in_the_column_is_noted_as_broken_before_the_first_step(scene) -> None:
    ground = scene("B")
    column, contacts = column_alone(ground).contact_list(), ground.contact_list()
    pairs = column.arrays
    pairs.state[np.flatnonzero(pairs.state == INTACT)[:6]] = [TENSION, SHEAR, SHEAR] * 2
    column.arrays.cracked[:6] = 5
    still = np.zeros((3, ground.count))
    contacts.copy_column(column, still)
    ours, cracks = contacts.arrays, contacts.take_cracks()
    broken = np.flatnonzero((ours.state == TENSION) | (ours.state == SHEAR))

    # each of the column, and its twins in the body; two bricks side by side have those within a brick twice
    assert len(cracks) == len(broken) > 2 * 6
    assert sorted(map(tuple, cracks.pair.tolist())) == sorted(
        zip(ours.first[broken].tolist(), ours.second[broken].tolist(), strict=True)
    )
    assert set(cracks.step) == {0}
    assert np.count_nonzero(cracks.shear) == np.count_nonzero(ours.state == SHEAR)
    assert (ours.cracked == -1).all()
    assert len(contacts.take_cracks()) == 0


def test_what_the_column_does_not_list_keeps_its_own_state(scene) -> None:
    ground = scene("B")
    column, contacts = column_alone(ground).contact_list(), ground.contact_list()
    column.arrays.state[:] = SHEAR
    column.arrays.shear[:] = 1.0
    # a pair of the column alone is struck off its list, so that neither it nor any twin of it is known there
    struck = listed(column, ground.seam.width)[7]
    kept = [key != struck for key in listed(column, ground.seam.width)]
    column.arrays = column.arrays._replace(
        **{name: getattr(column.arrays, name)[kept] for name in ("first", "second", "state", "shear", "slip")}
    )
    column._image = column._image[kept]
    contacts.copy_column(column, np.zeros((3, ground.count)))

    same = np.array([key == struck for key in twins_keys(contacts)])
    assert same.any()
    assert not (contacts.arrays.state[same] == SHEAR).any()
    assert not contacts.arrays.shear[same].any()
    assert (contacts.arrays.shear[~same] == 1.0).all()


LATTICE = {"pattern": "A", "size": [2.0, 1.0], "radius": 0.25}
HALF = {"right": {"type": "viscous", "half_mass": True}}


def half_cells(bar, **strength: float) -> tuple[ContactList, np.ndarray, np.ndarray]:
    """Four disks by two, those on the right half cells; which pairs are upright, and which of these on the right."""
    material = {"material.law": "linearpbond", "material.geometry": "reference", **strength}
    tables = {"packing": LATTICE, "boundary": HALF, "wave": {}, "monitor": [], "motion.held": []}
    contacts = build(bar({**tables, **material})).contact_list()
    first, second = (contacts.assembly.positions[end, 0] for end in (contacts.arrays.first, contacts.arrays.second))
    return contacts, first == second, (first == second) & (first == 1.75)


def sheared(contacts: ContactList, upper: tuple[float, ...], lower: tuple[float, ...] = (0.0, 0.0, 0.0)) -> np.ndarray:
    """The upper row moved by (m, m, rad), and the lower one."""
    high = contacts.assembly.positions[:, 1] > 0.5
    return np.where(high, np.array(upper)[:, None], np.array(lower)[:, None])


def test_half_contacts_push_half_as_hard(bar) -> None:
    contacts, upright, right = half_cells(bar)
    contacts.forces(sheared(contacts, (2e-5, 1e-5, 3e-5)))
    force = contacts.arrays.force

    assert (np.count_nonzero(upright), np.count_nonzero(right)) == (4, 1)
    assert np.abs(force[upright]).min() > 0.0
    # halves of the stiffness are exact, and so are all products with them
    assert np.array_equal(force[right][0], 0.5 * force[upright & ~right][0])


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
    contacts.forces(0.999 * sheared(contacts, upper, lower))
    assert not (contacts.arrays.state[upright] != INTACT).any()
    contacts.forces(1.001 * sheared(contacts, upper, lower))

    assert right.any()
    assert np.array_equal(contacts.arrays.state != INTACT, upright)

"""Places and times of spalls, from bonds broken by hand."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.bar.fracture import Spall, breaks_at_ends, cracked_since, spalls
from dembound.kernels.bar_cracks import OPENING
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Fracture, Rod

COUNT, SPACING, STEP = 41, 0.25, 1e-3
ROD = Rod.uniform(COUNT, SPACING, section=1.0, modulus=1e9, critical_stretch=1e-3)
PLACES = SPACING * np.arange(COUNT)
ENDS = {"left": PLACES[0], "right": PLACES[-1]}


def all_over(rod: Rod) -> Bonds:
    """Peridynamics with m = 3 all over."""
    made = Bonds(rod, 3, complement=False)
    made.add_zone(0, COUNT)
    return made


@pytest.fixture
def bonds() -> Bonds:
    return all_over(ROD)


@pytest.fixture
def tough() -> Bonds:
    """Bonds with a fracture energy."""
    return all_over(Rod((replace(ROD.ranges[0], fracture=Fracture(1e4)),)))


def cut(bonds: Bonds, plane: int, step: int, lengths: tuple[int, ...] = (1, 2, 3)) -> None:
    """Break the bonds of these lengths that cross a plane."""
    for p in lengths:
        across = np.arange(max(0, plane - p + 1), min(plane, COUNT - 1 - p) + 1)
        whole = across[bonds.bond[p - 1, across] > 0.0]
        bonds.bond[p - 1, whole] = 0.0
        bonds.bond_broken[p - 1, whole] = step


def opened(bonds: Bonds, plane: int, step: int) -> None:
    """Let all bonds across a plane begin to open in a step and break three steps later, as the kernel would."""
    bundle = bonds.opening.bundle
    for p in (1, 2, 3):
        for i in range(max(0, plane - p + 1), min(plane, COUNT - 1 - p) + 1):
            q = bundle.listed[0]
            bundle.row[q], bundle.first[q], bundle.began[q] = p - 1, i, step
            bundle.limit[q], bundle.apart[q], bundle.furthest[q] = 1e-3, 1e-2, 1e-2
            bundle.listed[0] += 1
            bonds.bond[p - 1, i], bonds.bond_broken[p - 1, i] = 0.0, step + 3


def test_a_cut_cracks_the_nodes_that_lose_three_tenths(bonds) -> None:
    assert np.array_equal(cracked_since(bonds), np.full(COUNT, -1))
    assert spalls(bonds, PLACES, STEP) == []
    cut(bonds, 20, step=7)
    since = cracked_since(bonds)

    # of 5 parts of a family 2.5 are beyond the cut, then 1.5, exactly three tenths, then 0.5
    assert np.flatnonzero(since >= 0).tolist() == [19, 20, 21, 22]
    assert np.all(since[19:23] == 7)
    place = (PLACES[19], PLACES[22])
    assert spalls(bonds, PLACES, STEP) == [Spall(7 * STEP, place, place)]


def test_a_spall_begins_when_the_first_node_has_lost_enough_with_those_of_that_step_alone(bonds) -> None:
    cut(bonds, 20, step=5, lengths=(1,))  # a fifth of the families of 20 and 21
    cut(bonds, 20, step=8, lengths=(2,))  # another fifth of theirs, and one of 19 and 22
    cut(bonds, 20, step=11, lengths=(3,))
    before = cracked_since(bonds)
    assert before[[19, 20, 21, 22]].tolist() == [11, 8, 8, 11]
    cut(bonds, 21, step=14)
    after = cracked_since(bonds)

    # 23 is beside the second cut as 22 was beside the first; the crack is not younger by it
    assert np.array_equal(after[before >= 0], before[before >= 0])
    assert np.flatnonzero((after >= 0) & (before < 0)).tolist() == [23]
    assert after[23] == 14
    (spall,) = spalls(bonds, PLACES, STEP)
    assert spall.time == pytest.approx(8 * STEP)
    assert (spall.start, spall.end) == ((PLACES[20], PLACES[21]), (PLACES[19], PLACES[23]))


@pytest.mark.parametrize(
    ("plane", "off", "nodes"), [(0, "left", (0, 0)), (20, None, (19, 22)), (39, "right", (40, 40))]
)
def test_a_bar_comes_off_an_end_where_its_node_is_the_first_to_crack(bonds, plane: int, off, nodes) -> None:
    cut(bonds, plane, step=3)
    (spall,) = spalls(bonds, PLACES, STEP)

    # the end node has lost all, the next one half a volume of three
    assert spall.end == (PLACES[nodes[0]], PLACES[nodes[1]])
    assert breaks_at_ends([spall], ENDS) == ({off: spall} if off else {})
    assert breaks_at_ends([spall], {}) == {}


def test_with_a_fracture_energy_a_spall_is_an_open_plane(tough) -> None:
    assert spalls(tough, PLACES, STEP) == []
    opened(tough, 20, step=5)
    place = (PLACES[20], PLACES[21])
    assert spalls(tough, PLACES, STEP) == [Spall(8 * STEP, place, place, 5 * STEP)]
    assert spalls(tough, PLACES, STEP)[0].describe()["began"] == 5e-3
    tough.bond[2, 18], tough.bond_broken[2, 18] = 1.0, OPENING  # one that still crosses it
    assert spalls(tough, PLACES, STEP) == []

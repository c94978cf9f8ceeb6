"""Ranges of a bar: the arrays they make, what bonds them, and zones that end where they do."""

import numpy as np
import pytest

from dembound.methods.bonds import Bonds
from dembound.methods.patch import Patch
from dembound.methods.rod import Range, Rod

EPS = np.finfo(float).eps

SOFT = Range(0, 20, 0.0, 0.5, section=2.0, modulus=3e9, density=1000.0, critical_stretch=1e-3, drag_rate=8.0)
STIFF = Range(20, 50, 10.0, 0.25, section=0.5, modulus=8e9, density=4000.0, critical_stretch=2e-3)
APART = Range(51, 61, 17.75, 0.25, section=0.5, modulus=8e9, density=4000.0, gap=0.25)
ROD = Rod((SOFT, STIFF, APART))
BONDED = Rod((SOFT, STIFF))


def test_arrays_of_nodes_and_planes_are_those_of_their_ranges() -> None:
    assert (ROD.count, ROD.bonded, ROD.touching) == (62, [(SOFT, STIFF)], [(STIFF, APART)])
    assert ROD.positions[[0, 19, 20, 21, 50, 51, 61]].tolist() == [0.0, 9.5, 10.0, 10.25, 17.5, 17.75, 20.25]
    # of a shared node half a cell of either range: 0.5 m³ at 1000 kg/m³ and 0.0625 m³ at 4000 kg/m³
    assert ROD.volumes[[0, 19, 20, 21, 50, 51]].tolist() == [0.5, 1.0, 0.5625, 0.125, 0.0625, 0.0625]
    assert ROD.mass[[19, 20, 21, 50]].tolist() == [1000.0, 750.0, 500.0, 250.0]
    assert ROD.springs[[19, 20, 49, 50, 51]].tolist() == [1.2e10, 1.6e10, 1.6e10, 0.0, 1.6e10]
    assert ROD.sections[[19, 20, 49, 50, 51]].tolist() == [2.0, 0.5, 0.5, 0.0, 0.5]
    assert ROD.elongation[[19, 20, 50, 51]].tolist() == [5e-4, 5e-4, np.inf, np.inf]
    # dashpots of 8 · 500 N·s/m on 750 kg
    assert ROD.drag_rate[[19, 20, 21]] == pytest.approx([8.0, 8.0 * 500.0 / 750.0, 0.0], rel=4 * EPS)


def test_a_place_is_that_of_the_nearest_node() -> None:
    places = [0.25, 0.75, 0.75 + 1e-12, 10.125, 10.375, 9.7, 9.8, 10.1, 17.6, 17.9, 20.25]
    assert [ROD.nearest(place) for place in places] == [0, 1, 1, 20, 21, 19, 20, 20, 51, 52, 61]


def tension(rod: Rod) -> np.ndarray:
    """Displacements (n,) m at which every plane of a bonded bar carries 1 kN."""
    return np.concatenate([[0.0], np.cumsum(1e3 / rod.springs)])


LAYOUTS = {"springs": [], "across": [(12, 30)], "all": [(0, 51)], "near": [(10, 18), (24, 40)]}


@pytest.mark.parametrize("horizon", [1, 3])
@pytest.mark.parametrize("zones", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_a_uniform_pull_is_at_rest_across_an_interface(zones: list[tuple[int, int]], horizon: int) -> None:
    bonds = Bonds(BONDED, horizon)
    for zone in zones:
        bonds.add_zone(*zone)
    bands, u = bonds.stiffness(), tension(BONDED)
    dense = sum(np.diag(band[: len(u) - d], -d) for d, band in enumerate(bands))
    force = (dense + np.tril(dense, -1).T) @ u

    assert force[[0, -1]] == pytest.approx([-1e3, 1e3], rel=1e-9)
    # up to ten pulls of k u ≤ 1.6e10 N/m · 8e-6 m
    assert np.abs(force[1:-1]).max() < 10 * EPS * 1.6e10 * u.max()
    # no bond joins nodes on both sides
    for row in range(horizon):
        assert not bonds.bond[row, max(0, 20 - row) : 20].any()


def test_without_complement_the_planes_beside_an_interface_are_completed_alone() -> None:
    bonds = Bonds(ROD, 3, complement=False)
    bonds.add_zone(0, ROD.count)
    completed = np.flatnonzero(bonds.spring)

    # three planes on either side of the bonded interface; at free ends and at a contact bonds alone carry the stress
    assert completed.tolist() == [17, 18, 19, 20, 21, 22]
    assert bonds.zones == [(0, 21), (20, 51), (51, 62)]


def test_soft_ends_are_those_that_are_not_bonded_and_have_half_a_spring() -> None:
    bonds = Bonds(ROD, 3, complement=False)
    bonds.soften_ends()

    halved = np.flatnonzero((ROD.springs > 0.0) & (bonds.spring == 0.5 * ROD.springs))
    assert halved.tolist() == [0, 49, 51, 60]


def test_a_patch_ends_with_its_range() -> None:
    method = Patch(type="patch", horizon=3, trigger=0.9, reach=1)
    bonds = method.begin(ROD)
    u = np.zeros(ROD.count)
    u[20:] = SOFT.elongation  # the last spring of the first range
    method.on_trigger(bonds, u)

    assert bonds.zones == [(16, 21)]
    u[:] = 0.0
    u[48:] = STIFF.elongation
    method.on_trigger(bonds, u)
    assert bonds.zones == [(16, 21), (44, 51)]
    # each stage has its zones in all ranges, so that the limit of the time step is that of any of them
    assert [len(stage.zones) for stage in method.stages(ROD)] == [0, 3, 3, 3, 3]


def test_a_contact_is_no_bond_that_could_break() -> None:
    bonds = Bonds(ROD, 0)
    u = np.zeros(ROD.count)
    u[51:] = 1.0

    assert bonds.triggered(u).size == 0
    assert not bonds.damage().any()
    assert bonds.alive == 60
    bonds.spring_broken[49], bonds.spring[49] = 3, 0.0
    # the node at the contact has lost all it had, the one before it the half volume there
    assert bonds.damage()[[49, 50, 51]] == pytest.approx([1.0 / 3.0, 1.0, 0.0], abs=4 * EPS)


def test_constants_for_kernels_are_those_of_each_range() -> None:
    bonds = Bonds(ROD, 3, trigger_ratio=0.5)
    bonds.add_zone(5, 10)
    bonds.add_zone(30, 40)
    arrays = bonds.arrays(np.array([0]), 1e-4)

    assert arrays.plain.tolist() == [[1, 5], [10, 20], [21, 30], [40, 50], [52, 61]]
    kept = (1.0 - 4e-4) / (1.0 + 4e-4)
    assert arrays.plain_keep == pytest.approx([kept, kept, 1.0, 1.0, 1.0], rel=2 * EPS)
    soft, stiff = 1e-4 / 1000.0 * 1.2e10 / (1.0 + 4e-4), 1e-4 / 500.0 * 1.6e10
    assert arrays.plain_push == pytest.approx([soft, soft, stiff, stiff, stiff], rel=8 * EPS)
    assert arrays.plain_limit.tolist() == [2.5e-4, 2.5e-4, 2.5e-4, 2.5e-4, np.inf]
    np.testing.assert_allclose(arrays.bond_limit, np.outer([5e-4, 5e-4], [1.0, 2.0, 3.0]), rtol=2 * EPS)
    assert [20, 21, 1] in arrays.mixed.tolist()  # the shared node has a keep of its own
    assert (arrays.contacts.left.tolist(), arrays.contacts.gap.tolist()) == ([50], [0.25])

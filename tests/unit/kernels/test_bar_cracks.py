"""Bonds that open, under displacements prescribed step by step."""

from collections import namedtuple

import numpy as np
import pytest

from dembound.kernels.bar import plane_force, stored
from dembound.kernels.bar_cracks import close_contacts, soften
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Fracture, Range, Rod

COUNT, SPACING, SECTION, MODULUS, STRETCH, ENERGY = 41, 0.25, 0.5, 2e9, 1e-3, 6e3
STRENGTH = MODULUS * STRETCH
OPEN = 2.0 * ENERGY / STRENGTH
"""w_c, 6 mm: 24 times the limit of a spring."""
PLACES = SPACING * np.arange(COUNT)


def rod(**law) -> Rod:
    fracture = Fracture(ENERGY, **law)
    return Rod((Range(0, COUNT - 1, 0.0, SPACING, SECTION, MODULUS, 1.0, STRETCH, fracture=fracture),))


def all_over(horizon: int, **law) -> Bonds:
    bonds = Bonds(rod(**law), horizon)
    bonds.add_zone(0, COUNT)
    return bonds


def a_zone(horizon: int) -> Bonds:
    bonds = Bonds(rod(), horizon)
    bonds.add_zone(12, 28)
    return bonds


LAYOUTS = {"finite differences": lambda: Bonds(rod(), 0), "three": lambda: all_over(3), "a seam": lambda: a_zone(3)}


@pytest.fixture(params=LAYOUTS.values(), ids=LAYOUTS.keys())
def bonds(request) -> Bonds:
    return request.param()


class Driven:
    """Bonds whose nodes are moved as prescribed, in steps of 1 s."""

    def __init__(self, bonds: Bonds) -> None:
        self.bonds, self.arrays = bonds, bonds.arrays(np.zeros(0, dtype=np.int64), 1.0)
        self.u, self.number, self.lost = np.zeros(COUNT), 0, 0.0

    def to(self, u: np.ndarray) -> float:
        """Move all nodes to u (n,) m; returns the energy (J) that bonds took."""
        self.number += 1
        self.arrays.reached[0] = 1
        lost = soften(self.number, u, u - self.u, 1.0, self.arrays)
        self.u = u
        self.lost += lost
        return lost

    def force(self, plane: int) -> float:
        return plane_force(plane, self.u, self.arrays)


def cracked(w: float, strain: float, plane: int = 13) -> np.ndarray:
    """Displacements of a bar under uniform strain with a crack of opening w (m) at a plane."""
    return strain * PLACES + w * (np.arange(COUNT) > plane)


def test_a_crack_follows_its_law_and_takes_its_energy(bonds) -> None:
    """One plane opens while the bar beside it is strained by σ/E.

    Tractions are those of the law to the rounding of displacements, 41 nodes of which add up. Every step is along the
    straight line of each bond, so that the triangles of the balance add up to the area below it, except in the first
    one, of a share 1/N of the opening: from half of the limit on, it takes half of what it should.
    """
    steps, run = 400, Driven(bonds)
    run.to(cracked(0.0, 0.5 * STRETCH))
    for share in np.arange(1, steps + 1) / steps:
        run.to(cracked(share * OPEN, (1.0 - share) * STRETCH))
        expected = STRENGTH * SECTION * (1.0 - share)
        for plane in (6, 13, 33):
            assert run.force(plane) == pytest.approx(expected, abs=1e-9 * STRENGTH * SECTION)
    assert run.lost == pytest.approx(ENERGY * SECTION, rel=0.51 / steps)
    assert sum(stored(run.u, run.arrays)) == pytest.approx(0.0, abs=1e-9 * ENERGY)
    row, first = bonds.opening["row"], bonds.opening["first"]
    assert np.all((first <= 13) & (first + np.maximum(row + 1, 1) > 13))  # nothing else has begun
    assert np.all(bonds.opening.of(bonds.spring_broken, bonds.bond_broken) == run.number)


def test_unloading_is_a_line_to_the_origin_and_pressure_meets_whole_bonds() -> None:
    run = Driven(Bonds(rod(), 0))
    run.to(cracked(0.0, 0.5 * STRETCH))
    run.to(cracked(0.4 * OPEN, 0.6 * STRETCH))
    elongation, force = 0.4 * OPEN + 0.6 * STRETCH * SPACING, 0.6 * STRENGTH * SECTION
    lost = run.lost
    for share in (0.7, 0.2, 0.5):
        run.to(share * cracked(elongation, 0.0))
        assert run.force(13) == pytest.approx(share * force, rel=1e-12)
    assert run.lost == lost
    for pressed in (-1e-5, -3e-5):
        run.to(cracked(pressed, 0.0))
        assert run.force(13) == pytest.approx(MODULUS * SECTION / SPACING * pressed, rel=1e-12)
    run.to(cracked(0.1 * elongation, 0.0))
    run.to(cracked(0.2 * elongation, 0.0))
    assert run.force(13) == pytest.approx(0.2 * force, rel=1e-12)
    run.to(cracked(1.1 * OPEN, 0.0))
    assert run.force(13) == 0.0
    run.to(cracked(-2e-5, 0.0))  # pieces that meet again
    assert run.force(13) == pytest.approx(MODULUS * SECTION / SPACING * -2e-5, rel=1e-12)
    assert run.bonds.spring_broken[13] == run.number - 1


@pytest.mark.parametrize(("rate", "gain"), [(0.5, 1.0), (10.0, 1.0 + 0.5 * np.log10(5.0)), (99.0, 1.5)])
def test_strength_follows_the_strain_rate(rate: float, gain: float) -> None:
    """Steps of 1 s at so small a stretch that rates are prescribed by the units: a stretch of rate·10⁻⁵ a step."""
    slow = 1e-5
    bonds = all_over(3, per_decade=0.5 * STRENGTH, rates=(2.0 * slow, 20.0 * slow))
    run = Driven(bonds)
    steps = 0
    while len(bonds.opening) == 0 and steps < 10_000:
        steps += 1
        run.to(cracked(0.0, steps * rate * slow))
    # the first step above half of the limit is counted whole, so a mean over k steps is wrong by up to 1/k
    counted = max(1.0, 0.5 * STRETCH / (rate * slow))
    assert bonds.opening["limit"][0] / (STRETCH * SPACING) == pytest.approx(gain, abs=0.5 * 0.4343 / counted + 1e-12)
    assert bonds.opening["apart"][0] * bonds.opening["limit"][0] == pytest.approx(OPEN * STRETCH * SPACING, rel=1e-12)


Touching = namedtuple("Touching", "left gap push closed")


def test_ranges_of_unequal_masses_just_touch_after_an_impact_and_keep_their_momentum() -> None:
    mobility, v, mean = np.array([1.0, 2.0, 0.5, 1.0]), np.array([0.0, 3.0, -1.0, 0.0]), np.zeros(4)
    u, momentum = 0.1 * v, np.sum(v / mobility)
    close_contacts(u, v, mobility, mean, 0.1, Touching(np.array([1]), np.array([0.02]), np.zeros(1), np.array([False])))
    assert u[1] - u[2] == pytest.approx(0.02, rel=1e-12)
    assert np.sum(v / mobility) == pytest.approx(momentum, rel=1e-12)

"""A case with larger disks: the same ground, places, loads and sides."""

import numpy as np
import pytest
from small_cases import Tables, small

from dembound.accuracy.of_disks.coarser import coarser, largest_diameter
from dembound.disks.matching import Held, homogenised_beta
from dembound.disks.scene import build
from dembound.disks.supports import forces_of

STEP = 1e-4

GROUND: Tables = {
    "packing": {"pattern": "A", "size": [24.0, 12.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {
        "right": {"type": "viscous", "beta_p": 0.6, "beta_s": 1.5},
        "bottom": {"type": "viscoelastic", "source": [5.0, 9.0], "alpha_n": 2.0, "alpha_s": 0.5},
    },
    "hole": [{"name": "hole", "type": "circle", "centre": [15.0, 6.0], "radius": 2.0}],
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.08}},
    "load": [
        {"name": "hammer", "force": [3.0, -7.0], "position": [5.25, 9.25], "wave": "pulse"},
        {"name": "push", "acceleration": [2.0, 1.0], "region": [8.0, 2.0, 9.0, 5.0], "wave": "pulse"},
    ],
    "monitor": [{"name": "top", "position": [20.25, 11.75]}],
    "run": {"duration": 0.02},
    "output": {"pictures": False, "snapshots": 3},
}
"""A lattice of 48 × 24 disks that is wider than high, with a hole, two loads and two kinds of sides."""


@pytest.fixture(scope="module")
def both():
    case = small(GROUND)
    scene = build(case)
    return scene, coarser(case, scene, STEP, 1.5)


def test_the_ground_is_as_large_within_half_a_cell_and_its_disks_as_large_as_asked_for(both):
    _, larger = both
    assert larger.case.packing.extent == pytest.approx((24.0, 12.0))
    assert 2.0 * larger.case.packing.radius == pytest.approx(1.5)
    assert larger.case.output.snapshots == 0
    # heights that no whole cells fill
    case = small(GROUND, changes={"packing.size": [24.0, 7.0], "hole": [], "load": [], "monitor": []})
    larger = coarser(case, build(case), STEP, 1.5).case
    assert larger.packing.extent[0] == pytest.approx(24.0)
    assert abs(larger.packing.extent[1] - 7.0) < 0.5 * 1.5


def test_loads_have_the_same_force_in_all_and_stay_where_they_are(both):
    finer, larger = both
    scene = build(larger.case)
    for before, after in zip(finer.case.load, larger.case.load, strict=True):
        (here, there), (forces, others) = zip(forces_of(before, finer), forces_of(after, scene), strict=True)
        np.testing.assert_allclose(others.sum(axis=0), forces.sum(axis=0), rtol=1e-9)
        middle, place = finer.positions[here].mean(axis=0), scene.positions[there].mean(axis=0)
        assert np.abs(place - middle).max() <= 0.5 * 1.5 + 1e-9
    assert np.abs(scene.monitored["top"] - finer.monitored["top"]).max() <= 0.5 * 1.5 + 1e-9


def test_dashpots_are_as_much_too_soft_or_too_hard_as_those_of_the_case(both):
    # On a lattice β0 is 1, and waves along the normal are reflected as (1 − β)/(1 + β) whatever the disks. The shares
    # of a whole cell's mass, tan(qD/4) = 0.011 of S waves, are added in quadrature: 0.011²/2/0.2, 0.2 % of the share.
    _, larger = both
    table, scene = larger.case.side("right"), build(larger.case)
    assert table.half_mass
    assert table.beta_p == pytest.approx(0.6 * homogenised_beta(scene, "right", "p"), rel=2e-3)
    assert table.beta_s == pytest.approx(1.5 * homogenised_beta(scene, "right", "s"), rel=2e-3)
    springs = larger.case.side("bottom")  # those of lattices are αG/L per length, without a factor of the packing
    assert (springs.alpha_n, springs.alpha_s) == (pytest.approx(2.0), pytest.approx(0.5))
    assert springs.source == (5.0, 9.0)


def test_springs_on_a_random_packing_are_as_stiff_per_length():
    # αGΣD/(HL) of both, of which ΣD/H is another one for random disks; G is that of the dashpots' medium
    packing = GROUND["packing"] | {"pattern": "B", "radius_ratio": 1.5, "brick": [6.0, 6.0], "seed": 1}
    side = {"type": "viscoelastic", "distance": 10.0, "alpha_n": 2.0}
    case = small(GROUND, changes={"packing": packing, "boundary": {"right": side}, "hole": [], "load": []})
    finer = build(case)
    larger = build(coarser(case, finer, STEP, 1.5).case)
    assert abs(finer.edges["right"].diameter_sum_ratio - 1.0) > 0.05
    np.testing.assert_allclose(Held.of(larger, "right").stiffness, Held.of(finer, "right").stiffness, rtol=1e-9)


def test_cells_whose_mass_matters_are_whole_in_a_third_case():
    # with matched dashpots all that a side of whole cells reflects is out of phase, tan(qD/4) and three times of that
    changes = {"boundary": {"right": {"type": "viscous"}}, "hole": [], "load": []}
    case = small(GROUND | {"boundary": {"left": {"type": "velocity", "wave_p": "pulse"}}}, changes=changes)
    found = coarser(case, build(case), STEP, 1.5)
    assert found.weight == pytest.approx(1.0 / 3.0, rel=0.05)
    assert found.case.side("right").half_mass
    assert not found.with_whole_cells.side("right").half_mass


def test_random_packings_become_lattices_with_their_wave_speeds():
    packing = GROUND["packing"] | {"pattern": "B", "radius_ratio": 1.5, "brick": [6.0, 6.0], "seed": 1}
    case = small(GROUND, changes={"packing": packing, "boundary": {}})
    finer = build(case)
    scene = build(coarser(case, finer, STEP, 1.5).case)
    assert scene.case.packing.pattern == "A"
    # by the brick's moduli C11 and C66, without C16, which couples P and S waves in a small brick
    moduli = finer.ground.material_tensor[[0, 3], [0, 3]]
    np.testing.assert_allclose(scene.ground.wave_speeds(0), np.sqrt(moduli / finer.ground.density), rtol=1e-6)
    assert scene.ground.density == finer.ground.density


def test_disks_are_small_enough_for_holes_and_the_scene():
    case = small(GROUND)
    assert largest_diameter(case, 9.0) == 1.0  # four across the hole of 4 m
    assert largest_diameter(case, 0.7) == 0.7
    assert largest_diameter(small(GROUND, changes={"hole": []}), 9.0) == 3.0  # and across the height

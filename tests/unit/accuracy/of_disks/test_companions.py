"""A case with larger disks: the same ground, places, loads and sides."""

from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
import pytest
from scene_tables import ISOTROPIC, grains, lattice, monitors, point, pulse
from small_cases import Tables, around, small

from dembound.accuracy.of_disks import enlarged as pairs
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.enlarged import pair_of
from dembound.accuracy.of_disks.equal_sides import with_plain_sides
from dembound.boundaries import Boundary
from dembound.disks.matching import Held, homogenised_beta
from dembound.disks.scene import DiskScene, build, with_boundaries
from dembound.disks.stability import choose_step
from dembound.disks.supports import forces_of

STEP = 1e-4

GROUND: Tables = {
    "packing": lattice(24.0, 12.0, 0.5),
    "material": ISOTROPIC,
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
    "monitor": monitors(top=(20.25, 11.75)),
    "run": {"duration": 0.02},
    "output": {"pictures": False, "snapshots": 3},
}
"""A lattice of 48 × 24 disks that is wider than high, with a hole, two loads and two kinds of sides."""

GRAINS, EMPTY = grains(24.0, 12.0, 0.5, 6.0), {"hole": [], "load": []}


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
    case = small(GROUND, changes={"packing.size": [24.0, 7.0], "monitor": []} | EMPTY)
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
    side = {"type": "viscoelastic", "distance": 10.0, "alpha_n": 2.0}
    case = small(GROUND, changes={"packing": GRAINS, "boundary": {"right": side}} | EMPTY)
    finer = build(case)
    larger = build(coarser(case, finer, STEP, 1.5).case)
    assert abs(finer.edges["right"].diameter_sum_ratio - 1.0) > 0.05
    np.testing.assert_allclose(Held.of(larger, "right").stiffness, Held.of(finer, "right").stiffness, rtol=1e-9)


def test_cells_whose_mass_matters_are_whole_in_a_third_case():
    # with matched dashpots all that a side of whole cells reflects is out of phase, tan(qD/4) and three times of that
    driven = GROUND | {"boundary": {"left": {"type": "velocity", "wave_p": "pulse"}}}
    case = small(driven, changes={"boundary": around("viscous", "right")} | EMPTY)
    found = coarser(case, build(case), STEP, 1.5)
    assert found.weight == pytest.approx(1.0 / 3.0, rel=0.05)
    assert found.case.side("right").half_mass
    assert not found.with_whole_cells.side("right").half_mass


def test_random_packings_become_lattices_with_their_wave_speeds():
    case = small(GROUND, changes={"packing": GRAINS, "boundary": {}})
    finer = build(case)
    scene = build(coarser(case, finer, STEP, 1.5).case)
    assert scene.case.packing.pattern == "A"
    # by the brick's moduli C11 and C66, without C16, which couples P and S waves in a small brick
    moduli = finer.ground.material_tensor[[0, 3], [0, 3]]
    np.testing.assert_allclose(scene.ground.wave_speeds(0), np.sqrt(moduli / finer.ground.density), rtol=1e-6)
    assert scene.ground.density == finer.ground.density


SCENE: Tables = {
    "packing": lattice(12.0, 6.0, 0.25),
    "material": ISOTROPIC,
    "boundary": around("viscous", "left", "right"),
    "wave": pulse(0.02, 1.0),
    "load": [point((1e5, 0.0), (8.875, 3.125))],
    "monitor": monitors(near=(10.875, 3.125)),
    "run": {"duration": 0.03},
    "output": {"pictures": False},
}
"""A lattice of 48 × 24 disks, with a load and a monitor nearer to its right side."""


@pytest.fixture(scope="module")
def scene():
    return build(small(SCENE))


def test_a_pair_that_can_be_afforded_has_the_smallest_disks_and_no_echoes(scene):
    pair = pair_of(scene.case, scene, choose_step(scene)[0], 1e9)
    assert pair.ratio == pairs.RATIOS[0]
    assert pair.echo_free
    assert pair.size[1] == pytest.approx(6.0, rel=0.1)  # free sides stay
    # waves of 1 km/s come 30 m in 0.03 s, and their precursors on disks of 0.75 m another 10 (30 m · 0.75²/8)^(1/3) =
    # 12.8 m: two sides from which nothing returns are as far apart, rounded up to whole cells each
    assert 42.8 <= pair.size[0] <= 42.8 + 2 * 0.76


def test_disks_stay_small_enough_for_waves_and_holes(scene):
    # the pulse of 20 ms has a tenth of its energy above some 50 Hz: S waves of 14 m, of which a seventh is 2 m, eight
    # times the diameter; but the height needs four disks, 1.5 m
    assert pairs.ratios(scene.case, scene) == [3.0, 4.0, 5.0, 6.0]
    short = small(SCENE, changes={"wave.pulse.period": 0.008})
    assert max(pairs.ratios(short, scene)) < 6.0
    hole = small(SCENE | {"hole": [{"name": "h", "type": "circle", "centre": [4.0, 3.0], "radius": 1.0}]})
    assert pairs.ratios(hole, build(hole)) == [2.0]


RANDOM: Tables = {"packing": grains(10.0, 5.0, 0.5, 5.0), "material": ISOTROPIC, "run": {"duration": 0.02}}


class Own(Boundary):
    """Dampers and springs along x and y, per metre of width or per disk, rising along the side by a share."""

    is_artificial: ClassVar[bool] = True

    type: Literal["own"] = "own"
    dampers: tuple[float, float] = (0.0, 0.0)
    springs: tuple[float, float] = (0.0, 0.0)
    per_disk: bool = False
    rising: float = 0.0

    def support(self, edge, medium, waves, supports):
        """Add dampers and springs."""
        each = np.ones(len(edge.nodes)) if self.per_disk else edge.widths
        each = each * (1.0 + self.rising * np.linspace(-0.5, 0.5, len(edge.nodes)))
        for component in (0, 1):
            damping, stiffness = self.dampers[component] * each, self.springs[component] * each
            supports.add(edge.nodes, component, damping=damping, stiffness=stiffness)


class Kept(Own):
    """A side like `Own` that does not represent ground beyond."""

    is_artificial: ClassVar[bool] = False


@pytest.fixture(scope="module")
def random_scene() -> DiskScene:
    return build(small(RANDOM))


def with_side(random_scene: DiskScene, side: str, table: Boundary) -> DiskScene:
    return with_boundaries(random_scene, replace(random_scene.case, boundary={side: table}))


@pytest.mark.parametrize(
    ("side", "per_disk", "springs"),
    [("right", False, (0.0, 0.0)), ("right", True, (3e7, 7e7)), ("top", False, (3e7, 7e7))],
)
def test_dampers_and_springs_are_those_per_metre_along_each_axis(random_scene, side, per_disk, springs) -> None:
    given = with_side(random_scene, side, Own(dampers=(2e6, 5e6), springs=springs, per_disk=per_disk))
    plain = with_plain_sides(given)
    assert plain.case.boundary[side].type == ("viscoelastic" if any(springs) else "viscous")
    for one, other in zip(Held.of(given, side), Held.of(plain, side), strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-12)  # rounding


def test_sides_stay_that_differ_along_them_or_are_part_of_the_problem(random_scene) -> None:
    for table in (Own(dampers=(2e6, 5e6), rising=0.1), Kept(dampers=(2e6, 5e6)), Own()):
        given = with_side(random_scene, "right", table)
        assert with_plain_sides(given) is given
    known = build(small(RANDOM, changes={"boundary.right": {"type": "viscoelastic", "distance": 3.0}}))
    assert with_plain_sides(known) is known


def test_larger_disks_that_fill_the_ground_end_at_its_free_surface():
    """Waves that enter at the bottom come back from there; beyond other sides of the box the ground goes on."""
    box = {
        "packing": {"pattern": "A", "size": [6.0, 6.0], "origin": [9.0, 3.0], "radius": 0.25},
        "ground": {"size": [24.0, 12.0]},
        "material": ISOTROPIC,
        "boundary": around("outside", "left", "right", "top") | {"bottom": {"type": "outside", "wave_s": "pulse"}},
        "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.08}},
        "monitor": monitors(wall=(9.25, 6.25)),
        "run": {"duration": 0.02},
    }
    case = small(box)
    larger = coarser(case, build(case), STEP, 1.5).case
    assert larger.packing.extent == pytest.approx((24.0, 12.0))
    assert larger.side("top").is_free
    assert [larger.side(side).is_outside for side in ("left", "right", "bottom")] == [True] * 3
    assert not [*larger.side("bottom").problems("bottom", {"boundary": larger.boundary, "load": ()})]


@pytest.mark.slow
def test_sides_that_end_at_another_height_in_larger_disks_have_other_shares_of_layers():
    """Ground of two heights, 12 and 7.5 m in disks of 0.5 m, of 1.5 m 12 and 7.5 or 9 m, on rock up to 4 m."""
    beside = around({"type": "free_field"}, "left", "right") | {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    changes = {
        "packing.size": [48.0, 12.0],
        "ground": {"surface": [[0.0, 12.0], [18.0, 12.0], [24.0, 7.5], [48.0, 7.5]]},
        "layer": [{"bottom": 4.0, "p_wave_speed": 400.0}, {"p_wave_speed": 1000.0}],
        "material": {"density": 2500.0, "fric": 0.5},
        "boundary": beside,
        "monitor": [],
    }
    case = small(GROUND, changes=changes | EMPTY)
    scene = build(case)
    for diameter in (1.0, 1.2, 1.5):
        larger = build(coarser(case, scene, STEP, diameter).case)
        assert larger.edges["right"].length < 12.0

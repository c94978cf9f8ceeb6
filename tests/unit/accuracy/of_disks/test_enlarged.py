"""The pair of scenes: how large its disks are, which sides move, and echoes."""

import pytest
from small_cases import Tables, small

from dembound.accuracy.of_disks import enlarged as pairs
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.enlarged import pair_of
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError

SCENE: Tables = {
    "packing": {"pattern": "A", "size": [12.0, 6.0], "radius": 0.125},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {"right": {"type": "viscous"}, "left": {"type": "viscous"}},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.02}},
    "load": [{"name": "hammer", "force": [1e5, 0.0], "position": [8.875, 3.125], "wave": "pulse"}],
    "monitor": [{"name": "near", "position": [10.875, 3.125]}],
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


def test_a_budget_that_is_too_small_leaves_echoes_and_the_largest_disks(scene):
    pair = pair_of(scene.case, scene, choose_step(scene)[0], 1.0)
    assert not pair.echo_free
    assert pair.ratio == max(pairs.ratios(scene.case, scene))
    assert pair.larger.size[0] == pytest.approx(12.0 + 2 * (pairs.SMALLER[-1] - 1.0) * 12.0, rel=0.1)  # at each side


def test_disks_stay_small_enough_for_waves_and_holes(scene):
    # the pulse of 20 ms has a tenth of its energy above some 50 Hz: S waves of 14 m, of which a seventh is 2 m, eight
    # times the diameter; but the height needs four disks, 1.5 m
    assert pairs.ratios(scene.case, scene) == [3.0, 4.0, 5.0, 6.0]
    short = small(SCENE, changes={"wave.pulse.period": 0.008})
    assert max(pairs.ratios(short, scene)) < 6.0
    hole = small(SCENE | {"hole": [{"name": "h", "type": "circle", "centre": [4.0, 3.0], "radius": 1.0}]})
    assert pairs.ratios(hole, build(hole)) == [2.0]


def test_pairs_that_cannot_be_run_are_refused(scene):
    with pytest.raises(CaseError, match=r"companions would take .* times the work that may be spent"):
        Companions(scene.case, scene, choose_step(scene)[0], 1.0).require_affordable()
    case = small(SCENE, changes={"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}}, "load": []})
    with pytest.raises(CaseError, match="lets motion in"):
        pair_of(case, build(case), 1e-5, 1e9)

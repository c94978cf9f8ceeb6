"""The pair of runs: which sides move, the sign of their difference, and echoes."""

import numpy as np
import pytest
from small_cases import Tables, small

from dembound.accuracy.history import History
from dembound.accuracy.of_disks import pair as pairs
from dembound.accuracy.of_disks.coarser import Coarser
from dembound.accuracy.of_disks.pair import Pair, run_pair
from dembound.accuracy.runner import Run, Runner
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError

TIME = np.linspace(0.0, 1.0, 41)

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


def gauge(x: float, y: float) -> History:
    """Motion at a constant velocity (m/s) along x and y, with a rotation that must not count."""
    motion = np.outer(TIME, [x, y, 9.0])
    return History.of(np.zeros(2), TIME, motion, np.tile([x, y, 9.0], (len(TIME), 1)))


def run_with(*motions: History, weight: float = 0.0) -> Pair:
    """A pair of the runs with these motions at monitor a; its scenes do not matter."""
    scene = build(small(SCENE))
    runs = tuple(Run(motions={"a": motion}) for motion in motions)
    return Pair(Coarser(scene.case, weight), 3.0, scene, scene, {}, True, runs)


def test_the_difference_is_own_less_far_at_the_times_of_the_record():
    pair = run_with(gauge(3.0, 1.0), gauge(1.0, 2.0))
    times = np.array([0.0, 0.33, 0.78])
    recorded = History(np.zeros(2), times, {})
    np.testing.assert_allclose(pair.difference(recorded, "a", "velocity"), np.tile([2.0, -1.0], (3, 1)))
    np.testing.assert_allclose(pair.difference(recorded, "a", "displacement"), np.outer(times, [2.0, -1.0]), atol=1e-12)


def test_whole_cells_add_their_part_with_their_weight():
    pair = run_with(gauge(3.0, 1.0), gauge(1.0, 2.0), gauge(7.0, 1.0), weight=0.25)
    found = pair.difference(History(np.zeros(2), TIME[:2], {}), "a", "velocity")
    np.testing.assert_allclose(found, np.tile([3.0, -1.0], (2, 1)))


@pytest.fixture(scope="module")
def scene():
    return build(small(SCENE))


def test_a_pair_that_can_be_afforded_has_the_smallest_disks_and_no_echoes(scene):
    pair = run_pair(scene.case, scene, choose_step(scene)[0], 1e9, Runner())
    assert pair.ratio == pairs.RATIOS[0]
    assert pair.echo_free
    assert pair.size[1] == pytest.approx(6.0, rel=0.1)  # free sides stay
    # waves of 1 km/s come 30 m in 0.03 s, and their precursors on disks of 0.75 m another 10 (30 m · 0.75²/8)^(1/3) =
    # 12.8 m: two sides from which nothing returns are as far apart, rounded up to whole cells each
    assert 42.8 <= pair.size[0] <= 42.8 + 2 * 0.76


def test_a_budget_that_is_too_small_leaves_echoes_and_the_largest_disks(scene):
    pair = pairs.pair_of(scene.case, scene, choose_step(scene)[0], 1.0)
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
    with pytest.raises(CaseError, match=r"a pair of runs would take .* times the work that may be spent"):
        run_pair(scene.case, scene, choose_step(scene)[0], 1.0, Runner())
    case = small(SCENE, changes={"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}}, "load": []})
    with pytest.raises(CaseError, match="lets motion in"):
        run_pair(case, build(case), 1e-5, 1e9, Runner())

"""Motion between the disks of a lattice, and where loads start waves."""

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.judge import extended
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.measured import errors_of_places
from dembound.accuracy.runner import measure
from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks.places import NINE, middle_of_loads, patch_around, weights_at
from dembound.kinds import with_changes
from dembound.running import Progress, plan


def lattice(**changes: object) -> DiskScene:
    """Disks of 0.5 m in 10 m × 2.5 m, the first at 0.25 m."""
    return build(small(PUSHED, changes=changes))


def test_quadratic_motion_is_found_at_any_place() -> None:
    """Products of parabolas along x and along y are what Lagrange's polynomials through nine places are made of."""
    patch = 0.5 * NINE + [3.25, 1.25]

    def motion(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray((1.0 - 2.0 * x + 0.5 * x**2) * (3.0 + y - 0.25 * y**2))

    for place in ([3.25, 1.25], [3.4, 1.1], [3.75, 0.9], [2.6, 1.9]):
        found = weights_at(patch, np.array(place)) @ motion(*patch.T)
        assert found == pytest.approx(float(motion(*np.array(place))), rel=1e-12)
    assert weights_at(patch[:1], np.array([9.0, 9.0])) == pytest.approx([1.0])
    assert weights_at(patch, np.array([9.0, 1.3])) == pytest.approx(weights_at(patch, np.array([4.25, 1.3])))


@pytest.mark.parametrize(
    ("place", "middle"),
    [((3.3, 1.3), (3.25, 1.25)), ((9.9, 2.4), (9.25, 1.75))],
    ids=["inside", "in a corner"],
)
def test_a_patch_is_the_nine_disks_that_are_nearest(place: tuple[float, float], middle: tuple[float, float]) -> None:
    np.testing.assert_allclose(patch_around(lattice(), np.array(place)), 0.5 * NINE + middle, atol=1e-12)
    low = lattice(**{"packing.size": [10.0, 1.0], "monitor": [{"name": "back", "position": [9.6, 0.2]}]})
    row = [[2.75, 0.25], [3.25, 0.25], [3.75, 0.25]]
    np.testing.assert_allclose(patch_around(low, np.array([3.3, 0.3])), row, atol=1e-12)
    assert weights_at(np.array(row), np.array([3.4, 0.9])) @ np.square([2.75, 3.25, 3.75]) == pytest.approx(3.4**2)


def test_places_are_seen_from_the_middle_of_the_loads_by_their_force() -> None:
    """The middle of 1 at (2.5, 1) and 3 at (6.5, 1) is (5.5, 1); a pressure counts from the middle of its hole."""
    loads = [
        {"name": "a", "force": [1e5, 0.0], "region": [2.0, 0.5, 3.0, 1.5], "wave": "push"},
        {"name": "b", "force": [0.0, -3e5], "region": [6.0, 0.5, 7.0, 1.5], "wave": "push"},
    ]
    cave = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.0, 1.5]}
    blast = {"name": "c", "pressure": 1e5, "hole": "cave", "wave": "push"}
    free = {"boundary": {}}

    def middle(**changes: object) -> np.ndarray | None:
        return middle_of_loads(build(small(PUSHED, changes=changes)))

    assert middle(load=loads, **free) == pytest.approx(np.array([5.5, 1.0]))
    assert middle(load=[blast], hole=[cave], **free) == pytest.approx(np.array([5.0, 1.0]))
    assert middle() is None  # driven


def test_loads_that_a_body_rests_under_start_no_waves() -> None:
    foot = {"name": "foot", "force": [0.0, -1e6], "region": [2.0, 0.5, 3.0, 1.5]}
    hit = {"name": "hit", "force": [1e5, 0.0], "region": [6.0, 0.5, 7.0, 1.5], "wave": "push"}
    at_rest = {"load": [foot, hit], "boundary": {}, "static": {"boundary": {"bottom": {"type": "fixed"}}}}
    assert middle_of_loads(build(small(PUSHED, changes=at_rest))) == pytest.approx(np.array([6.5, 1.0]))
    sudden = {"load": [foot, hit], "boundary": {}}
    found = middle_of_loads(build(small(PUSHED, changes=sudden)))
    assert found == pytest.approx(np.array([(10 * 2.5 + 6.5) / 11, 1.0]))


def test_a_load_nearer_to_a_surface_counts_even_if_monitors_have_moved_with_it() -> None:
    """Disks of 3 m have load and monitor 1 m lower below a surface than those of 1 m that were asked for.

    It is found from the change over a row of 3 m below, 2 m from that over 1 m above, so that what a wave of 88 m sends
    back comes by the phase 2·2π·2/88 = 0.29 too early or late; the disks of 3 m add less.
    """
    low, high = (
        small(
            PUSHED
            | {
                "packing": {"pattern": "A", "size": [30.0, 30.0], "radius": 0.5},
                "motion": {},
                "boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom")},
                "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
                "wave": {"push": {"type": "ricker", "amplitude": 1.0, "frequency": 8.0}},
                "load": [{"name": "hit", "force": [1e5, 1e5], "position": [10.5, y], "wave": "push"}],
                "monitor": [{"name": "there", "position": [16.5, y]}],
                "run": {"duration": 0.25},
            }
        )
        for y in (19.5, 20.5)
    )
    planned = plan(high)
    larger = build(with_changes(high, {"packing.radius": 1.5}))
    companions = Companions(high, planned.scene, planned.time_step, 1e9)
    found, time = errors_of_places(companions, larger)["there"]["velocity"], companions.recorded(larger)["there"].time
    runs = (measure(extended(case).case, Progress())[0] for case in (low, high))
    own, other = (run.motions["there"].at(time) for run in runs)
    true = (own.values["velocity"] - other.values["velocity"])[:, :2]

    assert np.linalg.norm(true) > 0.03 * np.linalg.norm(other.values["velocity"])
    assert np.linalg.norm(found - true) < 0.4 * np.linalg.norm(true)

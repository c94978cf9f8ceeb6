"""All factors of a case, each equal to the one found by its own calibration."""

import pytest

from dembound.errors import CaseError
from dembound.studies.all_sides import calibrate_all, changes_of, factors_of, summary_of
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate

DASHPOTS = {
    "motion.held": [],
    "boundary.right": {"type": "viscoelastic", "distance": 20.0},
    "boundary.top": {"type": "viscous", "beta_s": 0.8},
}


def test_sides_with_dashpots_have_a_factor_for_each_wave_that_can_move_them(bar) -> None:
    both = [(side, motion) for side in ("left", "right", "top") for motion in ("p", "s")]
    assert factors_of(bar(DASHPOTS)) == both
    # y is what P waves move at the top, S waves at the left and the right
    assert factors_of(bar(DASHPOTS | {"motion.held": ["y"]})) == [("left", "p"), ("right", "p"), ("top", "s")]
    assert factors_of(bar(DASHPOTS | {"motion.held": ["rotation"]})) == both
    grip = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "boundary.right": {"type": "fixed"}}
    with pytest.raises(CaseError, match="boundary: has no side with dashpots"):
        factors_of(bar(grip))


def test_each_factor_is_the_one_that_is_found_alone(bar) -> None:
    how, case = Calibrating(tolerance=1e-2), bar(DASHPOTS | {"boundary.right.beta_p": 0.7})
    passes = []
    found = calibrate_all(case, how, report=lambda each: passes.append((each.side, each.motion)))

    assert [(each.side, each.motion) for each in found] == factors_of(case)
    alone = {(side, motion): calibrate(case, side, how, motion=motion) for side, motion in factors_of(case)}
    assert changes_of(found) == {f"boundary.{s}.beta_{m}": each.result for (s, m), each in alone.items()}
    assert len(passes) == sum(len(each.beta) for each in found)

    summary = summary_of(found)
    assert summary["result"] == changes_of(found)
    assert [each["boundary"] for each in summary["calibrations"]] == [side for side, _ in factors_of(case)]
    assert summary["method"] == found[0].method

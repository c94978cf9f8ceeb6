"""Beside a load that stays a body with a continuum beyond its sides follows the half-space's ln t for a long time.

Z's ground (300 m/s) in a body of 51 × 20 disks, the receiver 20 disks from the load; elements of 6.4 m × 5 m, suited to
a load that is put on within half a second. The lattice itself, whose load and receiver lie half a disk deep, differs by
1e-4.
"""

import numpy as np
import pytest
from lasting import RISE, SPEED, exact_settlement, half_space, inner, on_a_grid, rule, settlement

TIMES = np.array([2.0 * RISE, 5.0, 10.0, 20.0])


def missing(times: np.ndarray = TIMES, **elements: int) -> np.ndarray:
    """Missing parts of the displacement at times (s), for elements in the margin and in the layers."""
    case = half_space(**elements)
    return 1.0 - settlement(case, times) / exact_settlement(case, times)


@pytest.mark.slow
def test_a_continuum_follows_the_half_space() -> None:
    """Within 0.5 % up to 10 s, 2 % at 20 s, and more closely with a larger margin; what is missing follows the rule.

    Measurements at c_p t/L from 70 to 200 lie within a quarter of the rule; these, 157 and 94, within a fifth.
    """
    near, far = missing(margin=1), missing(margin=3)

    assert np.abs(near[:3]).max() < 5e-3
    assert 5e-3 < near[3] < 2e-2
    assert np.abs(far).max() < 6e-3
    assert abs(near[0]) < 2e-4
    for margin, found in ((1, near[3]), (3, far[3])):
        assert found == pytest.approx(rule(SPEED * TIMES[3] / inner(half_space(margin=margin))), rel=0.2)


def test_dashpots_and_springs_do_not() -> None:
    until = TIMES[:3]
    expected = exact_settlement(half_space(), until)[2]

    assert settlement(half_space("viscous"), until)[2] > 15.0 * expected
    assert settlement(half_space("viscoelastic"), until)[2] < 0.2 * expected


def test_two_layers_are_marginal() -> None:
    assert missing(TIMES[:2], layers=2)[1] > 0.02


@pytest.mark.parametrize("ratio", [0.0, 0.25, 0.4])
def test_the_rule_holds_for_all_poissons_ratios(ratio: float) -> None:
    """Of a sudden load on a continuum alone; its short waves, which no disks filter, remain as 0.3 % of noise."""
    reached, size = np.array([90.0, 160.0]), 60.0
    found, expected, inside = on_a_grid(ratio, reached * size / SPEED)

    assert inside == size
    assert 1.0 - found / expected == pytest.approx(rule(reached), rel=0.5, abs=3e-3)

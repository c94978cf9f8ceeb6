"""The static fields of forces and holes beside elements."""

import math

import pytest

from dembound.continuum.interpolation import FORCES, HOLES, PASSED, TIES, WIDER, NearField

HOLE = (-2.0, -1.0, 4.0, 1.0)
"""6 m × 2 m, 3 m from elements: its field varies within 4 m."""


def blast(gap: float = 3.0) -> NearField:
    return NearField(HOLE, gap, "pressure")


@pytest.mark.parametrize("order", [3, 6])
def test_elements_beside_a_force_are_in_proportion_to_its_distance(order: int) -> None:
    near, far = (NearField((5.0, 5.0, 5.0, 5.0), gap, "force") for gap in (8.0, 16.0))
    side = near.largest_side(order, 1e-3)

    assert side == FORCES[order] * 8.0
    assert far.largest_side(order, 1e-3) == pytest.approx(2.0 * side)
    assert near.error(order, side) == pytest.approx(1e-3)
    assert near.error(order, 2.0 * side) == pytest.approx(8e-3)
    assert near._replace(gap=0.0).error(order, side) == near._replace(gap=0.0).largest_side(order, 1e-3) == 0.0


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_elements_as_wide_as_the_box_round_a_blast_have_the_measured_error_and_narrower_ones_less(order: int) -> None:
    assert blast().distance == 4.0
    assert blast().error(order, 8.0) == HOLES[order]
    assert blast().error(order, 4.0) == pytest.approx(HOLES[order] * 0.5 ** (order + 1))
    assert blast().error(order, 16.0) == pytest.approx(HOLES[order] * 2.0**WIDER)
    assert blast(7.0).error(order, 16.0) == HOLES[order]
    for accuracy in (1e-3, 0.1):
        assert blast().error(order, blast().largest_side(order, accuracy)) == pytest.approx(accuracy)


def test_beside_a_hole_that_waves_pass_it_is_the_part_of_the_motion_that_the_hole_makes() -> None:
    passed = blast()._replace(source="waves", wave_number=0.1)
    assert passed.error(4, 8.0) == pytest.approx(PASSED * 0.1 * 3.0 * (3.0 / 6.0) * HOLES[4])
    assert passed.error(4, 4.0) == pytest.approx(passed.error(4, 8.0) / 8.0)
    assert passed.error(4, passed.largest_side(4, 1e-3)) == pytest.approx(1e-3)
    assert passed._replace(wave_number=math.inf).error(4, 8.0) == HOLES[4]
    assert passed._replace(wave_number=0.0).largest_side(4, 1e-3) == math.inf
    assert passed.of_ties(1.0) == 0.0 == passed._replace(source="force").of_ties(1.0)
    assert blast().of_ties(0.5) == pytest.approx(TIES / 64.0)

"""Points, weights and derivatives against what defines them."""

import numpy as np
import pytest

from dembound.continuum.axis import Rule

EACH = pytest.mark.parametrize("order", range(3, 7))


def test_points_of_order_four_are_those_of_the_books() -> None:
    np.testing.assert_allclose(Rule(4).points, [-1.0, -np.sqrt(3 / 7), 0.0, np.sqrt(3 / 7), 1.0], rtol=0.0, atol=4e-16)
    np.testing.assert_allclose(Rule(4).weights, np.array([9, 49, 64, 49, 9]) / 90, rtol=1e-14)


@EACH
def test_the_quadrature_is_exact_up_to_degree_2p_minus_1(order: int) -> None:
    rule = Rule(order)
    for degree in range(2 * order):
        exact = 2.0 / (degree + 1) if degree % 2 == 0 else 0.0
        assert np.sum(rule.weights * rule.points**degree) == pytest.approx(exact, abs=1e-14)
    # a Lobatto rule is not exact one degree higher
    assert abs(np.sum(rule.weights * rule.points ** (2 * order)) - 2.0 / (2 * order + 1)) > 1e-4


@EACH
def test_shapes_interpolate_and_extrapolate_polynomials(order: int) -> None:
    rule, x = Rule(order), np.array([-1.3, -1.0, 0.123, 1.0, 1.2])
    # Lagrange polynomials grow to some 1.3^p beyond the ends
    np.testing.assert_allclose(rule.shape(x) @ rule.points**order, x**order, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(rule.shape(rule.points), np.eye(order + 1), rtol=0.0, atol=1e-14)

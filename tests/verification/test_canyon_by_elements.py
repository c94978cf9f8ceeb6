"""Boundary elements of cases/exact/canyon.py: their Green's function, and a canyon much smaller than the waves."""

import canyon
import numpy as np
import pytest


def test_greens_function_is_an_elastic_motion_of_a_unit_force() -> None:
    """Its gradient is that of its values, tractions round the force and ω² times the mass inside bear it."""
    rate, ratio, around = 3.0, 2.0, np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    x, small = np.array([[0.4, -0.7]]), 1e-5
    slope = canyon.green(x, rate, ratio)[1][0]
    for k, step in enumerate(small * np.eye(2)):
        change = canyon.green(x + step, rate, ratio)[0] - canyon.green(x - step, rate, ratio)[0]
        np.testing.assert_allclose(slope[k], change[0] / (2.0 * small), rtol=0.0, atol=1e-8)  # rounding / small

    out = np.column_stack([np.cos(around), np.sin(around)])
    near = 1e-3  # radius, at which inertia is 1e-5 of the force: ω² r² ln r
    pull = np.einsum("nikj,nk->ij", canyon.stress(canyon.green(near * out, rate, ratio)[1], ratio), out)
    np.testing.assert_allclose(pull * near * 2.0 * np.pi / len(around), -np.eye(2), rtol=0.0, atol=1e-4)


@pytest.mark.parametrize(("kind", "axis"), [("p", 2), ("sv", 1)])
def test_a_canyon_much_smaller_than_the_waves_moves_as_level_ground(kind: str, axis: int) -> None:
    """Within (ωa/c_s)² = 1.6 % times a logarithm, for S waves of 50 a: 3 %, the other component 3 % of it."""
    found = canyon.amplitudes(kind, 2.0, eta=0.04, size=0.25, reach=4.0)
    middle = np.abs(found[0]) < 1.5
    np.testing.assert_allclose(found[axis, middle], 2.0, rtol=0.03)
    np.testing.assert_allclose(found[3 - axis, middle], 0.0, atol=0.06)

"""Waves of a medium, against closed forms."""

import numpy as np
import pytest

from dembound.continuum.medium import Layered, Medium

ROCK = Medium.isotropic(2500.0, 1000.0, 600.0)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 90.0])
def test_isotropic_speeds_do_not_depend_on_the_direction(degrees: float) -> None:
    direction = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    speeds, polarisations = ROCK.plane_waves(direction)

    np.testing.assert_allclose(speeds, [600.0, 1000.0], rtol=1e-12)
    assert abs(polarisations[:, 1] @ direction) == pytest.approx(1.0)
    assert abs(polarisations[:, 0] @ direction) < 1e-12


def test_a_rotated_medium_has_rotated_waves() -> None:
    """Constants of an orthotropic medium turned by 30°, so that c16 and c26 act, from its 4th-order tensor."""
    plain = Medium(2000.0, c11=8e9, c22=6e9, c12=2e9, c66=1e9)
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    # stresses and strains (xx, yy, γ) under a rotation by 30°, Voigt
    bond = np.array([[c * c, s * s, -2 * s * c], [s * s, c * c, 2 * s * c], [s * c, -s * c, c * c - s * s]])
    m = bond @ plain.matrix @ bond.T
    turned = Medium(2000.0, m[0, 0], m[1, 1], m[0, 1], m[2, 2], m[0, 2], m[1, 2])

    np.testing.assert_allclose(turned.plane_waves((c, s))[0], plain.plane_waves((1.0, 0.0))[0], rtol=1e-12)
    np.testing.assert_allclose(turned.plane_waves((-s, c))[0], plain.plane_waves((0.0, 1.0))[0], rtol=1e-12)
    np.testing.assert_allclose(turned.matrix, m, rtol=1e-12)
    assert turned.moduli.tolist() == [m[0, 0], m[1, 1], m[0, 1], m[2, 2], m[0, 2], m[1, 2]]


@pytest.mark.parametrize("joints", [(10.0,), (20.0, 10.0)])
def test_joints_must_fit_the_layers(joints: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"3 layers have 2 joints, not 1|must ascend"):
        Layered((ROCK, ROCK, ROCK), joints)

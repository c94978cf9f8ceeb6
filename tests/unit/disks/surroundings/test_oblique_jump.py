"""Elements beside a slit under a motion of their top that has one slowness along x."""

import numpy as np
import pytest
from ground_motions import GENERAL

from dembound.continuum.medium import Medium, incident_wave, strain_of, waves_with
from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.part import GridBody
from dembound.disks.surroundings.jump import weights_on_slit
from dembound.disks.surroundings.oblique_jump import SlitElements

ISOTROPIC = Medium.isotropic(2500.0, 1000.0, 600.0)


@pytest.mark.parametrize("medium", [ISOTROPIC, GENERAL], ids=["isotropic", "general"])
@pytest.mark.parametrize("number", [0, 1], ids=["slower", "faster"])
def test_below_their_top_plane_waves_run_down(medium: Medium, number: int) -> None:
    """The motion and the traction m e^{−iω s_y y} and −iω C(m, s)·x̂ of either wave that runs down, above the layer.

    The wave has six elements of order 4 or more, 40 m and less; up to 0.09 % comes back from the layer.
    """
    mesh = Mesh.around(
        (0.0, 0.0, 10.0, 5.0), (2.5, 2.5), margin=Around(1, 1, 2), layer=Around(4, 4, 6), levels=(2, 1), slit=True
    )
    body = GridBody(mesh=mesh, medium=medium, thickness=1.5)
    wave = waves_with(medium, incident_wave(medium, "sv", 25.0).slowness[0])[1][number]
    omega = 2.0 * np.pi * 40.0
    motion, pull = (
        each[0] @ wave.motion for each in SlitElements(body, wave.slowness[0], 1e-5).below(np.array([omega]))
    )
    y = mesh.positions[mesh.doubled[0], 1]
    late = np.exp(-1j * omega * wave.slowness[1] * y)[:, None]
    above = y >= -5.0
    np.testing.assert_allclose(motion[above], (late * wave.motion)[above], atol=2e-3)
    stress = (-1j * omega * medium.matrix @ strain_of(*wave.slowness) @ wave.motion)[[0, 2]]
    expected = weights_on_slit(body)[:, None] * late * stress
    np.testing.assert_allclose(pull[above], expected[above], atol=2e-3 * np.abs(expected).max())
    assert not motion[0].any()

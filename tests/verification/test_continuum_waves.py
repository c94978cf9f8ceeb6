"""Plane waves in a continuum have the speeds of Christoffel's equation.

Central differences change frequencies ω to (2/Δt) asin(ωΔt/2), which is 0.4 % and taken into account. Elements of order
4 with eight nodes to a wavelength along an axis make waves slower by 3.6e-4, which is that of a row of elements, below.
"""

import numpy as np
import pytest
from grid_scene import GridScene, step_limit

from dembound.continuum.axis import Rule
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.motion.simulation import Simulation

MEDIA = {
    "isotropic": Medium.isotropic(2500.0, 1000.0, 1000.0 / np.sqrt(3.0)),
    "orthotropic": Medium(2500.0, c11=2.5e9, c22=1.8e9, c12=0.6e9, c66=0.5e9),
    "full": Medium(2500.0, c11=2.5e9, c22=1.8e9, c12=0.6e9, c66=0.7e9, c16=0.3e9, c26=-0.2e9),
}
CELLS, SIZE = 6, np.array([15.0, 10.0])
PERIODS = 20


def speed_along_a_row(turn: float) -> float:
    """Speed over that of the continuum of waves along elements of order 4, whose phase turns by `turn` in each.

    From the stiffness and mass of one element, the motion at its end being that at its beginning, turned.
    """
    rule = Rule(4)
    stiffness = 2.0 * rule.derivative.T @ np.diag(rule.weights) @ rule.derivative
    mass = 0.5 * np.diag(rule.weights)
    bloch = np.vstack([np.eye(4), np.exp(1j * turn) * np.eye(4)[0]])
    squares = np.linalg.eigvals(np.linalg.solve(bloch.conj().T @ mass @ bloch, bloch.conj().T @ stiffness @ bloch)).real
    return float(np.sqrt(squares.min()) / turn)


def measured_frequency(medium: Medium, waves: tuple[int, int], number: int) -> tuple[float, float]:
    """Angular frequencies (1/s) of a plane wave, measured and by Christoffel's equation.

    waves : its wavelengths in the width and height of a periodic mesh; number : 0 for the slower wave.
    """
    mesh = Mesh.uniform(order=4, element=(SIZE[0], SIZE[1]), cells=(CELLS, CELLS), periodic=(True, True))
    body = GridBody(mesh=mesh, medium=medium)
    step = 0.9 * step_limit(body)
    k = 2.0 * np.pi * np.array(waves) / mesh.size
    speeds, polarisations = medium.plane_waves((k[0], k[1]))
    expected = float(speeds[number] * np.hypot(*k))
    discrete = 2.0 / step * np.arcsin(0.5 * expected * step)
    phase, direction = mesh.positions @ k, polarisations[:, number]
    simulation = Simulation(GridScene(body), step)
    start, rate = np.zeros((2, 3, body.count))
    start[:2] = direction[:, None] * np.cos(phase)
    rate[:2] = expected * direction[:, None] * np.sin(phase + 0.5 * discrete * step)
    simulation.state.displacement, simulation.state.velocity = start, rate
    simulation.run(round(PERIODS * 2.0 * np.pi / discrete / step))
    along = body.mass * (direction @ simulation.state.displacement[:2])
    ahead = np.angle(np.sum(along * np.exp(1j * phase)) * np.exp(-1j * discrete * simulation.time))
    return 2.0 / step * np.sin(0.5 * step * (discrete + ahead / simulation.time)), expected


@pytest.mark.parametrize(
    ("name", "waves", "number"),
    [("isotropic", (3, 0), 0), ("orthotropic", (0, 3), 1), ("full", (2, -2), 0), ("full", (1, 3), 1)],
)
def test_speed(name: str, waves: tuple[int, int], number: int) -> None:
    found, expected = measured_frequency(MEDIA[name], waves, number)
    slower = 1.0 - speed_along_a_row(2.0 * np.pi * 3 / CELLS)

    assert 3.5e-4 < slower < 3.7e-4
    if 0 in waves:
        # other waves of these elements, a part of 1e-3 of the start, change the phase after 20 periods by 1e-3/40π
        assert found / expected == pytest.approx(1.0 - slower, rel=2e-5)
    else:
        # each axis has longer waves than that
        assert found / expected == pytest.approx(1.0, rel=slower)

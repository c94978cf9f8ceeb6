"""A harmonic wave on a bar of nodes has the frequency that L eq. 12 gives it."""

import numpy as np
import pytest

from dembound.exact import Lattice, courant_limit
from dembound.motion.simulation import Simulation

STEPS = 200
CENTRAL = {"type": "finite_difference"}
BARS = [(1, CENTRAL), *((m, {"type": "peridynamics", "horizon": m}) for m in (1, 3, 8))]


@pytest.mark.parametrize(("horizon", "method"), BARS, ids=["central", "1", "3", "8"])
@pytest.mark.parametrize(("share", "part"), [(0.3, 0.03), (0.9, 0.7), (0.9, 1.0)])
def test_standing_wave_keeps_its_frequency(lab, horizon, method, share, part):
    """At every step u = cos ωt cos kx, at a node that the ends do not influence; k is a part of the shortest wave's."""
    middle = horizon * STEPS
    scene = lab.bar(2 * middle, method)
    step = share * courant_limit(horizon) * lab.diameter / lab.speed
    lattice = Lattice(horizon, lab.diameter, step, lab.speed)
    wavenumber = part * lattice.shortest
    frequency = float(lattice.frequency(wavenumber))

    simulation = Simulation(scene, step, np.array([middle]))
    shape = np.cos(wavenumber * (scene.positions[:, 0] - scene.positions[middle, 0]))
    simulation.state.u[0, simulation.state.layout.slot] = shape
    simulation.state.v[0, simulation.state.layout.slot] = shape * 2.0 * np.sin(0.5 * frequency * step) ** 2 / step
    record = simulation.advance(STEPS + 1)

    # each step rounds u and Δt·v by a few ε; a velocity error made at step k moves the node for all steps left, so the
    # worst sum is 4ε·STEPS²/2, 2e-11
    tolerance = 2.0 * np.finfo(float).eps * STEPS**2
    expected = np.cos(frequency * step * np.arange(STEPS + 1))
    np.testing.assert_allclose(record[:, 0, 0], expected, rtol=0, atol=tolerance)

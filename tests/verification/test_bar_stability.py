"""The stability limit of a bar of nodes is sharp: bounded just below it, blown up just above."""

import numpy as np
import pytest

from dembound.errors import RunError
from dembound.exact import courant_limit
from dembound.motion.simulation import Simulation

CELLS = 200
HORIZONS = [1, 2, 3, 4, 5, 6, 8, 10]


def begin(lab, horizon: int, share: float, method: str = "peridynamics") -> Simulation:
    """A bar at a share of the limit of an endless one, with random velocities and no strain."""
    table = {"type": method} | ({"horizon": horizon} if method == "peridynamics" else {})
    scene = lab.bar(CELLS, table)
    step = share * courant_limit(horizon) * lab.diameter / lab.speed
    simulation = Simulation(scene, step)
    simulation.state.v[0, simulation.state.layout.slot] = np.random.default_rng(0).standard_normal(scene.count)
    return simulation


def energy(simulation: Simulation) -> float:
    return 0.5 * float(np.sum(simulation.scene.mass * simulation.state.velocity[0] ** 2))


@pytest.mark.parametrize("horizon", HORIZONS)
def test_limit_is_that_of_an_endless_bar(lab, horizon):
    # between free ends the shortest wave is a little longer: its phase from node to node is π − ψ with ψ near π/CELLS.
    # That takes ½ψ²|q''| from q(π), |q''| ≤ ½q(π) (½/m² and 1/ν²), and adds half of it, at most ⅛ψ², to the step
    limit = lab.bar(CELLS, {"type": "peridynamics", "horizon": horizon}).step_limit()
    endless = courant_limit(horizon) * lab.diameter / lab.speed
    assert 0.0 <= limit / endless - 1.0 < 0.25 * (np.pi / CELLS) ** 2


@pytest.mark.parametrize("horizon", HORIZONS)
def test_bounded_below_the_limit(lab, horizon):
    simulation = begin(lab, horizon, 0.999)
    start = energy(simulation)
    simulation.advance(2000)
    # ½mv² + ½uⁿKuⁿ⁺¹ is conserved and at least ½mv²(1 − r²) at the share r of the limit
    assert energy(simulation) < start / (1.0 - 0.999**2)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_grows_above_the_limit(lab, horizon):
    check_growth(begin(lab, horizon, 1.001))


def test_central_differences_grow_above_theirs(lab):
    check_growth(begin(lab, 1, 1.001, "finite_difference"))


def check_growth(simulation: Simulation) -> None:
    """The highest mode's amplitude grows by (r + √(r² − 1))² = e^0.088 a step, its energy by e^176 in 1000.

    It has about one of 200 parts of the energy at the start. e^92 = 1e40.
    """
    start = energy(simulation)
    with pytest.raises(RunError, match="grew without bound"):
        simulation.advance(1000)
    assert energy(simulation) > 1e40 * start

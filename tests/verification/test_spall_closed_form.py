"""A triangular pulse breaks a piece of the length off a bar that d'Alembert gives, to first order in the spacing.

Finite differences at cΔt = Δx carry a sampled pulse exactly (test_exact_at_courant_one): the stresses g of springs,
halfway between nodes and steps, follow g_{n+1} = 2p_n − g_n. They run along a straight leg without error, and where
the slope changes by Δa a step, a part φ of a step after a sample, they begin to swing about it by Δa|½ − φ|. So the
stress is wrong by parts of what it changes by in a step, and the place by parts of a cell: first order in Δx.
"""

import numpy as np
import pytest

from dembound.exact import triangle_spall
from dembound.motion.simulation import Simulation

RISE, FALL = 0.04e-3, 0.08e-3
PRESSURES = np.linspace(11e6, 18e6, 8)


@pytest.mark.parametrize("pressure", PRESSURES)
def test_break_is_within_a_step_and_a_cell_and_a_half(rock, pressure):
    """With 1 mm the crest comes 0.6 steps after a sample, and the legs' slopes are as 2 to −1.

    In slopes of the fall the swings are 2·½ + 3·0.1 = 1.3 in either wave; against the 2 by which the sum of both
    changes in a cell, 1.3 cells in all. The nearest spring may be half a cell away; the worst of both do not meet.
    """
    scene = rock.scene(
        {"type": "finite_difference"},
        load={"pressure": pressure},
        wave={"type": "triangle", "amplitude": 1.0, "rise": RISE, "fall": FALL},
        strength=rock.strength,
    )
    step = rock.step(scene, 1.0)
    simulation = Simulation(scene, step)
    simulation.advance(int(0.48e-3 / step))
    cracks = simulation.system.take_cracks(simulation.state.step)
    place, time = triangle_spall(rock.length, rock.speed, RISE, FALL, pressure, rock.strength)
    assert cracks.position[0, 0] == pytest.approx(place, abs=1.5e-3)
    assert cracks.step[0] * step == pytest.approx(time, abs=step)

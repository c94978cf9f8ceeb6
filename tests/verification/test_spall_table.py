"""Peridynamic bars spall where and when L's table 1 says.

The printed times are rounded to 0.1 µs, a step of the runs, and edges to 1 mm. L's families were found by a distance a
little above mΔx, so that a bond breaks some steps sooner or later here: 0.5 µs, in which a wave runs 1.4 mm, and
2.5 mm, this way and one half of a cell and of the rounding.
"""

import numpy as np
import pytest

from dembound.fracture import spalls
from dembound.simulate import Simulation

ROWS = [
    (3, 1.0, 12e6, 0.12e-3, (906.0, 909.0), 439.5e-6),
    (5, 1.0, 12e6, 0.12e-3, (901.0, 908.0), 439.9e-6),
    (10, 1.0, 12e6, 0.12e-3, (900.0, 910.0), 440.7e-6),
    (3, 0.5, 12e6, 0.12e-3, (905.0, 907.0), 438.9e-6),
    (5, 0.5, 12e6, 0.12e-3, (904.0, 908.0), 439.2e-6),
    (3, 1.0, 12e6, 0.24e-3, (811.0, 816.0), 512.6e-6),
    (3, 1.0, 15e6, 0.12e-3, (924.0, 928.0), 432.7e-6),
]
"""Horizon, spacing (mm), pressure (Pa) and length (s) of the pulse; edges of the first cracked range (mm), time (s)."""


@pytest.mark.parametrize(("horizon", "millimetres", "pressure", "length", "edges", "time"), ROWS)
def test_row_of_table_1(rock, horizon, millimetres, pressure, length, edges, time):
    scene = rock.scene(
        {"type": "peridynamics", "horizon": horizon},
        spacing=1e-3 * millimetres,
        load={"pressure": pressure},
        wave=rock.triangle(length),
        strength=rock.strength,
    )
    step = 1e-7 * millimetres
    simulation = Simulation(scene, step, np.zeros(0))
    simulation.advance(round(time / step) + 100)
    first = spalls(simulation.engine.bonds, scene.positions[:, 0], step)[0]
    assert first.time == pytest.approx(time, abs=0.5e-6)
    assert 1e3 * np.array(first.start) == pytest.approx(edges, abs=2.5)

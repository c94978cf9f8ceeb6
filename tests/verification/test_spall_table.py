"""The bars that are shipped for L's table 1 are those printed there, and spall where and when it says.

The printed times are rounded to 0.1 µs, a step of the runs, and edges to 1 mm. L's families were found by a distance a
little above mΔx, so that a bond breaks some steps sooner or later here: 0.5 µs, in which a wave runs 1.4 mm, and
2.5 mm, this way and one half of a cell and of the rounding.
"""

from pathlib import Path

import numpy as np
import pytest

from dembound.bar.fracture import spalls
from dembound.kinds import load
from dembound.motion.simulation import Simulation
from dembound.running import plan

CASES = Path(__file__).parents[2] / "cases" / "lu2016"
PRINTED = np.genfromtxt(CASES / "table1.csv", delimiter=",", names=True, skip_header=1)


@pytest.mark.parametrize("row", range(1, len(PRINTED) + 1))
def test_row_of_table_1(row):
    case, printed = load(CASES / f"table1_row{row}.toml"), PRINTED[row - 1]
    (hit,) = case.load
    pulse = case.wave[hit.wave]
    settings = case.method.horizon, 1e3 * case.bar.spacing, 1e-6 * hit.pressure * pulse.peak(), 1e3 * pulse.duration()
    assert settings == pytest.approx([printed[name] for name in ("m", "dx_mm", "p_m_MPa", "t_0_ms")])

    planned = plan(case)
    step, time = planned.time_step, 1e-3 * printed["t_F_ms"]
    simulation = Simulation(planned.scene, step)
    simulation.advance(round(time / step) + 100)
    first = spalls(simulation.system.parts[0].bonds, planned.scene.positions[:, 0], step)[0]
    assert first.time == pytest.approx(time, abs=0.5e-6)
    assert 1e3 * np.array(first.start) == pytest.approx([printed["x_from_mm"], printed["x_to_mm"]], abs=2.5)

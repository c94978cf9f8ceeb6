"""The energies of a wave that enters from a continuum below: what came in, what left, and what the continuum took."""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

PERIOD = 0.05
PULSE = {"type": "cosine", "amplitude": 1.0, "period": PERIOD}


def scene(lab, pattern: str):
    size, packing = ((0.5, 10.0), {}) if pattern == "A" else ((5.0, 10.0), {"brick": (5.0, 5.0)})
    bottom = {"type": "outside", "wave_s": "pulse", "wave_p": "pulse"}
    sides = {"left": "periodic", "right": "periodic", "bottom": bottom}
    return build(lab.case(pattern, size, held=(), material={"fric": 0.5}, boundary=sides, wave=PULSE, **packing))


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_it_comes_in_through_the_bottom_and_leaves_there(lab, pattern) -> None:
    """∫ρc v² dt = ⅜ρcT per metre and wave comes in. The dashpots of ties take what the continuum does not get."""
    column = scene(lab, pattern)
    simulation = Simulation(column, choose_step(column)[0], side_stride=1)
    ledger = Ledger(simulation, 50)
    simulation.track(ledger)
    simulation.run(int(0.25 / simulation.time_step))
    last, most = ledger.entries[-1], max(entry.kinetic for entry in ledger.entries)
    of = dict(zip(ledger.side_names, ledger.side_columns[-1].tolist(), strict=True))
    speeds, polarisations = column.outside.body.medium.plane_waves((0.0, 1.0))
    both = (polarisations.T @ [1.0, 1.0]) ** 2
    expected = 0.375 * PERIOD * column.size[0] * 2500.0 * float(speeds @ both)
    came_in, left, _ = of["bottom"]
    assert came_in == pytest.approx(expected, rel=1e-6)
    assert left == pytest.approx(came_in, rel=2e-3)
    assert of["bottom.continuum"][0] == pytest.approx(left, rel=1e-2)
    assert last.damping == pytest.approx(of["bottom.continuum"][0], rel=1e-2)
    assert abs(last.loads) < 1e-12 * most
    # sums of some thousand steps, each rounded by ε of the total
    assert max(abs(entry.error) for entry in ledger.entries) < 2000 * np.finfo(float).eps * most


def test_a_continued_run_has_the_same_bits(lab) -> None:
    column = scene(lab, "B")
    step = choose_step(column)[0]
    whole = Simulation(column, step)
    whole.run(300)
    first, second = Simulation(column, step), Simulation(scene(lab, "B"), step)
    first.run(117)
    second.state.take(first.state.arrays())
    second.run(300)
    assert np.abs(whole.state.u).max() > 0.0
    assert np.array_equal(whole.state.u, second.state.u)
    assert np.array_equal(whole.state.v, second.state.v)

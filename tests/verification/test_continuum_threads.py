"""A continuum's motion, memories and energies do not depend on the number of threads.

Every block of elements is computed by one thread, every shared node sums its elements in their order, and energies are
summed in chunks that are the same for any number of threads.
"""

import numba
import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion import threads
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.outside.alone import GridScene, step_limit
from dembound.outside.body import GridBody
from dembound.outside.medium import Medium
from dembound.outside.mesh import Around, Mesh


def run_with(number: int) -> dict[str, np.ndarray]:
    """All arrays of the state after a run with so many threads, and its energy ledger."""
    numba.set_num_threads(number)
    assert threads.thread_count_for(1000) == number
    mesh = Mesh.around((0.0, 0.0, 40.0, 20.0), (10.0, 10.0), margin=Around(2, 2, 1, 0), layer=Around(3, 2, 3, 0))
    body = GridBody(mesh=mesh, medium=Medium.isotropic(2500.0, 1000.0, 600.0))
    step = 0.9 * step_limit(body)
    simulation = Simulation(GridScene(body), step)
    noise = np.random.default_rng(0).standard_normal((3, body.count)) * ~mesh.held
    noise[2] = 0.0
    simulation.state.velocity = noise
    ledger = Ledger(simulation, 10)
    simulation.track(ledger)
    simulation.run(300)
    return simulation.state.arrays() | {"energies": ledger.columns, "time_step": np.array(step)}


def wave_with(number: int, lab) -> dict[str, np.ndarray]:
    """The same of a periodic body that a wave enters from a continuum below."""
    numba.set_num_threads(number)
    sides = {"left": "periodic", "right": "periodic", "bottom": {"type": "outside", "wave_s": "pulse"}}
    wave = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
    scene = build(lab.case("B", (5.0, 10.0), brick=(5.0, 5.0), held=(), boundary=sides, wave=wave))
    simulation = Simulation(scene, choose_step(scene)[0], side_stride=1)
    ledger = Ledger(simulation, 10)
    simulation.track(ledger)
    simulation.run(300)
    return simulation.state.arrays() | {"energies": ledger.columns, "sides": ledger.side_columns}


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
@pytest.mark.parametrize("run", [run_with, wave_with])
def test_same_bits(monkeypatch, lab, run):
    monkeypatch.setattr(threads, "PARTICLES_PER_THREAD", 1)  # else a scene as small as this has one thread
    before = numba.get_num_threads()
    more = () if run is run_with else (lab,)
    try:
        one, *others = [run(number, *more) for number in sorted({1, 2, numba.config.NUMBA_NUM_THREADS})]
    finally:
        numba.set_num_threads(before)
    assert np.abs(one["displacement"]).max() > 0.0
    for other in others:
        for name, values in one.items():
            np.testing.assert_array_equal(other[name], values, err_msg=name)

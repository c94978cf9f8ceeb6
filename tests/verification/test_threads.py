"""The result does not depend on the number of threads: every particle sums its own row of contacts."""

import numba
import numpy as np
import pytest

from dembound.disks.stability import step_limit
from dembound.motion import threads
from dembound.motion.simulation import Simulation

STEPS = 300


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_same_bits_for_one_and_two_threads(lab, monkeypatch):
    monkeypatch.setattr(threads, "PARTICLES_PER_THREAD", 1)  # else a scene as small as this has one thread
    boundary = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
    case = {"held": (), "boundary": boundary, "wave": lab.pulse(0.02)}
    before = numba.get_num_threads()
    results = []
    try:
        for number in (1, 2):
            numba.set_num_threads(number)
            assert threads.thread_count_for(1000) == number
            scene = lab.scene("B", (40.0, 10.0), **case)
            simulation = Simulation(scene, 0.9 * step_limit(scene), np.arange(scene.count))
            record = simulation.advance(STEPS)
            state = simulation.state
            results.append((record, state.displacement, state.velocity, simulation.time_step))
    finally:
        numba.set_num_threads(before)
    for one, two in zip(*results, strict=True):
        np.testing.assert_array_equal(one, two)
    assert np.abs(results[0][2]).max() > 0.1  # the pulses did run

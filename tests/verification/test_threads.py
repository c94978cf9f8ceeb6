"""Results do not depend on the number of threads, as nothing is summed in an order that depends on it.

Each particle sums its own row of contacts. Energies and work are summed in chunks of particles and contacts that are
the same for any number of threads, and chunks are added in order. A sum that threads share, each adding what it has
found, has as many partial sums as there are threads, and differs in its last bits with a probability near one in each
of the entries compared here.
"""

import numba
import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.system import DiskSystem
from dembound.motion import threads
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

STEPS = 300

ROWS, FEW = (40.0, 10.0), (20.0, 10.0)
"""Sizes of scenes whose copies of a brick are stepped side by side, and disk by disk."""

WEAK = {"law": "linearpbond", "fric": 0.3, "pb_ten": 0.2e6, "pb_coh": 0.2e6, "pb_fa": 30.0, "damp": 0.1}
"""Contacts open and slide and bonds break under the pulses."""

INPUT = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}
ENDS = {"left": INPUT, "right": "viscous"}
FREE_FIELD = {"left": "free_field", "right": "free_field", "bottom": INPUT}
SETTLED = {"ratio": 0.5, "boundary": {"bottom": {"type": "fixed"}}}
WEIGHT = [{"acceleration": [0.0, -9.81]}]

SCENES = {
    "elastic": {"size": ROWS, "boundary": ENDS, "material": {"damp": 0.1}},
    "elastic, held": {"size": ROWS, "boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}}, "held": ("y",)},
    "elastic, disk by disk": {"size": FEW, "boundary": ENDS, "material": {"damp": 0.1}},
    "breaking": {"size": ROWS, "boundary": ENDS, "material": WEAK},
    "breaking, disk by disk": {"size": FEW, "boundary": ENDS, "material": WEAK},
    "settled, free field": {
        "size": ROWS,
        "boundary": FREE_FIELD,
        "material": {"law": "linearpbond", "fric": 0.5},
        "static": SETTLED,
        "load": WEIGHT,
    },
    "settled, box in the ground": {"box": (20.0, 20.0, 40.0, 40.0), "static": SETTLED, "load": WEIGHT},
}


@pytest.fixture(params=SCENES)
def case(lab, request):
    """A case under strong pulses."""
    words = {"held": (), **SCENES[request.param]}
    if "box" in words:
        hole = {"name": "hole", "type": "circle", "centre": [30.0, 30.0], "radius": 4.0}
        return lab.window("B", words.pop("box"), changes={"hole": [hole]}, **words)
    return lab.case("B", words.pop("size"), wave={"type": "cosine", "amplitude": 1.0, "period": 0.02}, **words)


def run_with(number: int, case) -> dict[str, np.ndarray]:
    """All arrays of the state after a run with so many threads, and its energy ledger."""
    numba.set_num_threads(number)
    assert threads.thread_count_for(1000) == number
    scene = build(case)
    step = choose_step(scene)[0]
    if case.static is None:
        simulation = Simulation(scene, step)
    else:
        start = settle(scene).start
        simulation = Simulation(scene, step, system=DiskSystem(scene, step, start), datum=start.displacement)
    ledger = Ledger(simulation, 10)
    simulation.track(ledger)
    simulation.run(STEPS)
    return simulation.state.arrays() | {"energies": ledger.columns, "time_step": np.array(step)}


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_same_bits_of_motion_contacts_and_energies(case, monkeypatch):
    monkeypatch.setattr(threads, "PARTICLES_PER_THREAD", 1)  # else a scene as small as this has one thread
    before = numba.get_num_threads()
    try:
        one, *others = [run_with(number, case) for number in sorted({1, 2, numba.config.NUMBA_NUM_THREADS})]
    finally:
        numba.set_num_threads(before)
    for other in others:
        assert other.keys() == one.keys()
        for name, values in one.items():
            np.testing.assert_array_equal(other[name], values, err_msg=name)
    assert np.abs(one["velocity"]).max() > 0.1  # the pulses did run
    assert (np.abs(one["energies"][1:, 1:4]) > 0.0).all()  # kinetic, in contacts and in bonds
    if case.material.pb_ten is not None:
        assert one["work/crack"][1] > 0.0
        assert one["work/friction"][1] > 0.0

"""A body that is let go at time zero has fallen by gt²/2, at the speed gt, at the times of its record.

Central differences follow a constant acceleration exactly if the first kick is half a kick. A whole one makes motion
half a step early, by 1/2n of the speed after n steps. Tolerances are rounding: n steps of one addition each.
"""

import json

import h5py
import numpy as np
import pytest
from small_cases import PUSHED, SPALLING, TORN, small

from dembound.motion.simulation import Simulation
from dembound.running import plan, resume_case, run_case

G, STEP = 9.81, 1e-3
WEIGHT = [{"name": "weight", "acceleration": [0.0, -G]}]
FALL = {
    "packing": {"pattern": "A", "bricks": [1, 1], "radius": 0.25},
    "material": {"density": 2000.0, "p_wave_speed": 300.0},
    "load": WEIGHT,
    "monitor": [{"name": "m", "position": [0.25, 0.25]}],
    "run": {"duration": 0.1, "time_step": STEP},
    "output": {"snapshots": 3, "history_interval": 0.01, "pictures": False, "energy_interval": STEP},
}


def test_a_recorded_fall(tmp_path) -> None:
    folder = run_case(small(FALL, "fall"), tmp_path)
    for end in (0.1, 0.13):  # continued, which does not change what was there
        summary = json.loads((folder / "summary.json").read_text())
        last = summary["monitors"]["m"]["end"]
        assert last["time"] == pytest.approx(end, rel=1e-12)
        assert last["velocity"][1] == pytest.approx(-G * end, rel=1e-12)
        assert last["displacement"][1] == pytest.approx(-0.5 * G * end**2, rel=1e-12)
        assert summary["energy"]["relative_error"] < 1e-12
        with h5py.File(folder / "run.h5") as file:
            shots = list(file["snapshots"].values())
            history = file["histories/m"]
            time, velocity, moved = (history[name][:] for name in ("time", "velocity", "displacement"))
            for shot in shots:
                assert shot["velocity"][0, 1] == pytest.approx(-G * shot.attrs["time"], rel=1e-12)
        np.testing.assert_allclose(time, 0.01 * np.arange(len(time)), rtol=1e-12)
        assert len(time) == round(end / 0.01)
        np.testing.assert_allclose(velocity[:, 1], -G * time, rtol=1e-12)
        np.testing.assert_allclose(moved[:, 1], -0.5 * G * time**2, rtol=1e-12)
        if end == 0.1:
            folder = resume_case(folder, until=0.13)


@pytest.mark.parametrize("case", [small(PUSHED, "ahead", TORN), small(SPALLING)], ids=["disks", "bar"])
def test_a_step_ahead_leaves_no_trace_in_summaries(case) -> None:
    """Of a run whose bonds break: contacts of disks may be a step ahead; and the motion is that of the next record."""
    planned = plan(case)
    simulation, whole = (Simulation(planned.scene, planned.time_step, planned.scene.probes) for _ in range(2))
    simulation.advance(planned.steps // 2)
    before = simulation.state.arrays()
    with simulation.a_step_ahead() as motion:
        ahead = motion.copy()
        assert simulation.state.step == before["step"] + 1
    after = simulation.state.arrays()
    assert before.keys() == after.keys()
    for name, values in before.items():
        assert name.startswith("system/body/") or np.array_equal(values, after[name]), name
    assert np.array_equal(whole.advance(planned.steps // 2 + 1)[-1], ahead)

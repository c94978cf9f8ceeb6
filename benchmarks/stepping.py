"""Cases of disks that are stepped in blocks, in this process or in a worker, also with older revisions of the package.

Only what has hardly changed is used: to load a case and change keys, to build its scene, to choose the step and to
advance.
"""

from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from processes import serve
from timing import timed

DAMPED = "elastic, Q = 20"
"""The name of damped ground, which older revisions do not have."""

LAWS: dict[str, dict[str, Any]] = {
    "elastic": {},
    "linearpbond, reference": {"material.geometry": "reference"},
    "linearpbond, updated": {"material.geometry": "updated"},
    DAMPED: {"material.quality_factor": 20.0},
}
"""Laws that are measured -> changes of the case; the history-dependent law is used from the first step."""

AMPLITUDE = 1e-3
"""Amplitude of the waves of a case (m/s), as small as the random velocities: then the cost of a step does not depend
on where a wave is, and pairs are not listed anew as disks are carried along."""

BAR = """
[packing]
pattern = "{pattern}"
bricks = [{across}, {up}]
radius = 0.25
{random}
[material]
density = 2500.0
p_wave_speed = 1000.0
[run]
duration = 1.0
"""
RANDOM = """
radius_ratio = 1.5
brick = [10.0, 10.0]
seed = 1
"""


def bar(pattern: str, across: int, up: int) -> str:
    """A case of so many bricks of pattern A (one disk each) or B (432 disks each), free at all sides."""
    return BAR.format(pattern=pattern, across=across, up=up, random=RANDOM if pattern == "B" else "")


def law_changes(law: str) -> dict[str, Any]:
    """Changes of a case for a law of `LAWS`."""
    changes = LAWS[law]
    if law == DAMPED:
        return changes
    return {"material.law": "linearpbond", "material.elastic_start": False, **changes} if changes else {}


def prepare(case: str, law: str = "elastic") -> Any:
    """The simulation of a case, a file or the text of one, under a law, at rest."""
    from dembound.disks.scene import build
    from dembound.disks.stability import choose_step
    from dembound.errors import CaseError
    from dembound.kinds import load, loads, with_changes
    from dembound.motion.simulation import Simulation

    loaded = loads(case) if "\n" in case else load(Path(case))
    waves = {f"wave.{name}.amplitude": AMPLITUDE for name in loaded.wave}
    changed = with_changes(loaded, law_changes(law) | waves)
    with suppress(CaseError):  # where there is this key: all particles of the case are to be moved
        changed = with_changes(changed, {"reduce.rows": False})
    scene = build(changed)
    return Simulation(scene, choose_step(scene)[0])


def set_velocity(simulation: Any, velocity: np.ndarray) -> None:
    """Give all particles a velocity (3, n); in older revisions it is a plain array, which is written to."""
    if "velocity" in vars(simulation.state):
        simulation.state.velocity[:] = velocity
    else:
        simulation.state.velocity = velocity


def set_in_motion(simulation: Any) -> None:
    """Give all particles small random velocities, the same at every call."""
    set_velocity(simulation, np.random.default_rng(0).normal(0.0, 1e-3, (3, simulation.scene.count)))


def steps_for(simulation: Any, seconds: float) -> int:
    """Steps that take about so many CPU seconds, at least two; compiles what the steps call."""
    simulation.advance(2)
    steps, taken = 1, 0.0
    while taken < 0.2 * seconds:
        steps *= 2
        taken = timed(partial(simulation.advance, steps)).cpu
    return max(2, round(steps * seconds / taken))


class Stepping:
    """Holds one simulation at a time and answers requests to step it."""

    def __init__(self) -> None:
        self.simulation: Any = None

    def open(self, case: str, law: str, threads: int) -> dict[str, float]:
        """Prepare a case and set all its particles in motion; returns their number and the time step (s)."""
        import numba

        numba.set_num_threads(threads)
        self.simulation = prepare(case, law)
        set_in_motion(self.simulation)
        return {"count": int(self.simulation.scene.count), "time_step": float(self.simulation.time_step)}

    def steps_for(self, seconds: float) -> int:
        """Number of steps that take about this many seconds, see `steps_for`."""
        return steps_for(self.simulation, seconds)

    def block(self, steps: int) -> list[float]:
        """CPU and wall seconds of so many steps."""
        return list(timed(lambda: self.simulation.advance(steps)))


if __name__ == "__main__":
    stepping = Stepping()
    serve({"open": stepping.open, "steps_for": stepping.steps_for, "block": stepping.block})

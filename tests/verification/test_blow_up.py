"""A run above the stability limit stops with time and place and shows no spall; a sound fracture never stops one.

Above the limit the shortest waves grow until something breaks, and as a bar with broken bonds is softer that may be the
end of it: what is left looks like a fractured bar. So it is the step that decides what a break means, not its looks.
"""

import numpy as np
import pytest

from dembound.errors import RunError
from dembound.motion.simulation import Simulation

SPACING = 5e-3
METHODS = {
    "finite_difference": {"type": "finite_difference"},
    "m = 8, corrected ends": {"type": "peridynamics", "horizon": 8, "corrected_ends": True},
    "switch": {"type": "switch", "horizon": 3},
    "patch": {"type": "patch", "horizon": 3},
}
SUDDEN = {"type": "triangle", "amplitude": 1.0, "rise": 1e-9, "fall": 0.12e-3}
SMOOTH = {"type": "ricker", "amplitude": 1.0, "frequency": 20e3}
RUNS = pytest.mark.parametrize(("wave", "share"), [(SUDDEN, 1.001), (SMOOTH, 1.5)], ids=["sudden", "smooth"])


@pytest.fixture(scope="module", params=METHODS.values(), ids=METHODS.keys())
def begin(request, rock):
    """Begins a run with a time step that is a multiple of the stability limit, whatever the wave and the strength."""
    limit = rock.scene(request.param, spacing=SPACING).step_limit()

    def start(share: float, wave: dict, **bar) -> Simulation:
        scene = rock.scene(request.param, spacing=SPACING, load={"pressure": 12e6}, wave=wave, **bar)
        return Simulation(scene, share * limit)

    return start


def go_on(simulation: Simulation, breaks: list[int]) -> None:
    """A thousand steps, by the hundred, in which the fastest of these runs grow by 1e83; breaks of each are added."""
    for _ in range(10):
        simulation.advance(100)
        breaks.append(len(simulation.system.take_cracks(simulation.state.step)))


@RUNS
def test_unbreakable_bar_stops_with_time_and_place(begin, share, wave):
    """At 1.001 of the limit the shortest wave grows by e^0.09 a step: e^90 in all, whatever it began with."""
    simulation = begin(share, wave)
    with pytest.raises(RunError, match=r"at t = \S+ s near \(\S+, 0\) m"):
        go_on(simulation, [])


def test_it_is_seen_at_a_late_look_too(rock):
    """At 1.02 of the limit by e^0.4 a step, 1e269 in 1550: a speed whose square is no number any more."""
    scene = rock.scene({"type": "finite_difference"}, spacing=SPACING, load={"pressure": 12e6}, wave=SUDDEN)
    simulation = Simulation(scene, 1.02 * scene.step_limit())
    with pytest.raises(RunError, match="at t = "):
        simulation.advance(1550)
    assert 1e200 < np.abs(simulation.state.velocity).max() < np.inf


@pytest.mark.parametrize("strength", [10e6, 1e6])
@RUNS
def test_breakable_bar_stops_before_a_break_is_reported(begin, share, wave, strength):
    simulation = begin(share, wave, strength=strength)
    breaks: list[int] = []
    with pytest.raises(RunError, match="at t = "):
        go_on(simulation, breaks)
    assert not any(breaks)


@pytest.mark.parametrize(("wave", "share", "strength"), [(SUDDEN, 1.0, 1e6), (SMOOTH, 0.5, 10e6)])
def test_sound_fracture_goes_on(begin, share, wave, strength):
    """Up to the limit itself, though fronts that jump by more than the strength break springs within a step."""
    simulation = begin(share, wave, strength=strength)
    simulation.run(int(0.8e-3 / simulation.time_step))
    assert len(simulation.system.take_cracks(simulation.state.step)) > 0

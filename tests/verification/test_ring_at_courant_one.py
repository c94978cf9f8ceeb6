"""At cΔt = Δx a kink of what drives an end leaves the springs of finite differences swinging from step to step.

A load p on the half end node, or a wave p/(ρc) that a dashpot lets in there, sends f(n − i) into the bar with

    f(n + 1) − f(n − 1) = 2p^n Δx/E :    g(n + ½) + g(n − ½) = 2p^n ,

g being the pressure in the springs: odd and even steps know nothing of each other. Where p bends by a slope Δa, a part
φ of a step after a sample, g swings about p from then on by Δa Δt |½ − φ|: by half of what a step changes if the bend
is on a sample, not at all if it is halfway. The mean of two springs, the stress at a node, never swings. What swings
leaves with the wave where a dashpot takes it, and comes back from a free end.
"""

import numpy as np
import pytest

from dembound.motion.simulation import Simulation

CELLS, FIRST, RISE, FALL = 200, 50, 20, 60
"""Of the bar, and before the spring that is looked at; of the pulse in steps."""


@pytest.fixture(params=["load", "viscous_input"])
def swing(request, rock):
    """Finds pressure in a spring less that of the pulse (k,), in parts of its crest; it begins `late` steps late."""

    def find(late: float) -> np.ndarray:
        spacing = rock.length / CELLS
        step = spacing / rock.speed
        wave = {"type": "triangle", "amplitude": 1.0, "rise": RISE * step, "fall": FALL * step, "start": late * step}
        impedance = rock.density * rock.speed  # for a crest of 1 m/s either way
        if request.param == "load":
            words = {"load": {"pressure": impedance}}
        else:
            words = {"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}}}
        scene = rock.scene({"type": "finite_difference"}, spacing=spacing, wave=wave, **words)
        steps = 2 * CELLS - FIRST - 1  # before anything is back from the other end
        motion = Simulation(scene, step, np.array([FIRST, FIRST + 1])).advance(steps)[:, :, 0]
        since = step * (np.arange(steps) - FIRST - 0.5)
        return (motion[:, 0] - motion[:, 1]) / step - scene.case.wave["pulse"].velocity(since)

    return find


@pytest.mark.parametrize("late", [0.0, 0.25, 0.5, 0.75])
def test_springs_swing_by_what_the_bend_says(swing, late):
    """Between front and crest, to the rounding of displacements, which come to 40 units."""
    rising = swing(late)[FIRST + 2 : FIRST + RISE]
    expected = abs(0.5 - late) / RISE
    np.testing.assert_allclose(np.abs(rising), expected, rtol=0, atol=1e-12)
    if expected > 0.0:
        assert np.all(rising[1:] * rising[:-1] < 0.0)


def test_bends_halfway_between_steps_never_ring(swing):
    np.testing.assert_allclose(swing(0.5), 0.0, rtol=0, atol=1e-12)

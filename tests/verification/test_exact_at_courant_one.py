"""Finite differences at cΔt = Δx are d'Alembert's solution itself: they carry a sampled load without any error.

Then u_i^{n+1} = u_{i+1}^n + u_{i−1}^n − u_i^{n−1}, which travelling shapes f(n − i) + g(n + i) solve. At the
loaded end, with half a mass, u_0^{n+1} = 2u_1^n − u_0^{n−1} + 2p^nΔx/E, which a wave to the right solves with

    f(n + 1) − f(n − 1) = 2p^nΔx/E :  the mean velocity over two steps at node i is p^{n−i}/(ρc), the stress −p^{n−i}.

A free end with half a mass, u_N^{n+1} = 2u_{N−1}^n − u_N^{n−1}, reflects: velocities come back as they are, stresses
reversed. So the motion is the sum over images that d'Alembert gives, sample by sample.
"""

import numpy as np

from dembound.exact import bar_stress, bar_velocity
from dembound.motion.simulation import Simulation

PRESSURE, PULSE = 10e6, 0.12e-3
PASSAGES = 6
PLACES = [0, 250, 500, 901, 1000]
CELLS = 1000


LARGEST = PASSAGES * PULSE * 2740.0 * CELLS
"""Bound of displacements in units of what the peak moves a node in a step: each passage adds half a pulse twice."""

TOLERANCE = 4.0 * np.finfo(float).eps * LARGEST * np.sqrt(PASSAGES * CELLS)
"""Rounding of displacements kicks the velocities by up to ε of them at every step, either way: four times the root."""


def test_velocity_and_stress_are_those_of_dalembert(rock):
    """Through several reflections."""
    scene = rock.scene({"type": "finite_difference"}, load={"pressure": PRESSURE}, wave=rock.triangle(PULSE))
    step = rock.step(scene, 1.0)
    steps = PASSAGES * CELLS
    record = Simulation(scene, step, np.array(PLACES)).advance(steps)
    time, impedance = step * np.arange(steps), rock.density * rock.speed

    def load(t: np.ndarray) -> np.ndarray:
        return PRESSURE * scene.case.wave["pulse"].velocity(t)

    for index, place in enumerate(np.array(PLACES) / CELLS):
        expected = bar_velocity(place, time, load, rock.length, rock.speed, impedance)
        np.testing.assert_allclose(record[:, index, 3], expected, rtol=0, atol=TOLERANCE * expected.max())
        if 0.0 < place < 1.0:
            stress = bar_stress(place, time, load, rock.length, rock.speed)
            np.testing.assert_allclose(record[:, index, 6], stress, rtol=0, atol=TOLERANCE * PRESSURE)

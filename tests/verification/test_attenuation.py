"""Waves in a bar with an attenuation α fade as exp(−αx), L eq. 19, from one passage to the next.

u_tt + 2αc u_t = c² u_xx has k = (ω/c)√(1 − 2jαc/ω), which fades by α(1 − (αc/ω)²/2) over a metre: high frequencies all
alike. In a lattice, too, a wave loses the part αc of its amplitude in a second, in which its group runs less than c.
"""

from itertools import pairwise

import numpy as np
import pytest

from dembound.exact import Lattice
from dembound.motion.simulation import Simulation

CELLS, CYCLES, PASSAGES = 400, 6, 6
ALPHA = 0.52

METHODS = {
    "finite_difference": ({"type": "finite_difference"}, 1.0, 20),
    "peridynamics": ({"type": "peridynamics", "horizon": 3, "corrected_ends": True}, 0.5, 40),
}
"""Method, Courant number, and cells per wavelength, enough for the bursts of all passages to stay in their turns."""


@pytest.mark.parametrize(("method", "courant", "cells"), METHODS.values(), ids=METHODS.keys())
def test_amplitude_fades_from_passage_to_passage(rock, method, courant, cells):
    """The amplitude at the burst's own frequency in the middle, fitted by a line through its logarithms.

    What is left out is a product of two of the corrections, each far below 1; one of them is (αc/ω)².
    """
    spacing, theta = rock.length / CELLS, 2.0 * np.pi / cells
    step = courant * spacing / rock.speed
    horizon = 3 if method["type"] == "peridynamics" else 1
    lattice = Lattice(horizon, spacing, step, rock.speed)
    omega = float(lattice.frequency(theta / spacing))
    burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": omega / (2.0 * np.pi), "cycles": CYCLES}
    scene = rock.scene(method, spacing=spacing, load={"pressure": 1e6}, wave=burst, attenuation=ALPHA)
    steps = int((PASSAGES + 1) * CELLS / courant)
    velocity = Simulation(scene, step, np.array([CELLS // 2])).advance(steps)[:, 0, 3]
    turning = velocity * np.exp(-1j * omega * step * np.arange(steps))
    middle = 0.5 * (CELLS + CYCLES * cells)  # of the burst, when it first passes the gauge
    begins = ((middle + (np.arange(PASSAGES + 1) - 0.5) * CELLS) / courant).astype(int)
    amplitude = [abs(turning[begin:end].sum()) for begin, end in pairwise(begins)]
    way = rock.length * np.arange(PASSAGES)
    fitted = -np.polyfit(way, np.log(amplitude), 1)[0]
    slower = rock.speed / float(lattice.group_velocity(theta / spacing))
    expected = ALPHA * (1.0 - 0.5 * (ALPHA * rock.speed / omega) ** 2) * slower
    assert fitted == pytest.approx(expected, rel=(ALPHA * rock.speed / omega) ** 2)

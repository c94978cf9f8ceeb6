"""Delays of plane waves on disks: closed forms for the square lattice."""

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.disks.scene import build
from dembound.formulas.disks.waves import AXES, DIAGONAL, delay_of

DIAMETER, PATH = 0.5, 300.0
PHASE = 0.1
"""Wave number in radians per disk: the next terms of the expansions are smaller by PHASE²."""


def lateness(motion, directions, step=0.0, fric=0.0):
    """(c/c(q) − 1)/(qD)² at `PHASE`."""
    ground = build(small(PUSHED, changes={"material.fric": fric, "boundary": {}, "load": []})).ground
    speed = ground.wave_speeds(0)[0 if motion == "p" else 1]
    delay = delay_of(ground, motion, directions, PATH, speed, step)
    omega = np.array([PHASE * speed / DIAMETER])
    return float(delay(omega)[0] * speed / PATH / PHASE**2), speed


@pytest.mark.parametrize("axis", [0, 1])
def test_p_waves_along_an_axis_are_those_of_a_row_of_masses(axis):
    # ω = (2c/D) sin(qD/2), so c/c(q) = 1 + (qD)²/24
    assert lateness("p", [AXES[axis]])[0] == pytest.approx(1.0 / 24.0, rel=0.01)


def test_s_waves_along_an_axis_are_early_as_disks_turn():
    # With k_s = 1, R = 1/2 and bending stiffness b = k_b/(R² k_s), and the disks' inertia mR²/2, the two equations
    # ω²m = 2 − 2cos q − 4 sin² q/(6 + 2cos q + b(2 − 2cos q) − ω²m/2) give ω²m = q²/2 + q⁴(1/48 − (1/4 − b)/16).
    # Bonds alone carry shear (fric = 0): k_b = k̄_s R²/3 for k_n = k_s, where k_b belongs to the bond's area, b = 1/3.
    b = 1.0 / 3.0
    expected = -(1.0 / 48.0 - (0.25 - b) / 16.0)
    assert lateness("s", [AXES[0]])[0] == pytest.approx(expected, rel=0.02)
    assert lateness("s", [DIAGONAL])[0] > 0.0
    found = [lateness("s", [direction])[0] for direction in (AXES[0], DIAGONAL)]
    assert lateness("s", [AXES[0], DIAGONAL])[0] == max(found, key=abs)  # of several the largest delay counts


def test_a_time_step_makes_waves_earlier():
    # sin(ω'Δt/2) = ωΔt/2, so ω' = ω(1 + (ωΔt)²/24): of a row at Courant number 1 nothing is left
    _, speed = lateness("p", [AXES[0]])
    assert lateness("p", [AXES[0]], step=DIAMETER / speed)[0] == pytest.approx(0.0, abs=1e-4)
    assert lateness("p", [AXES[0]], step=0.5 * DIAMETER / speed)[0] == pytest.approx(0.75 / 24.0, rel=0.01)
    # nothing is known above the shortest wave
    ground = build(small(PUSHED, changes={"boundary": {}, "load": []})).ground
    delay = delay_of(ground, "p", [AXES[0]], PATH, 1000.0, 0.0)
    assert np.isnan(delay(np.array([0.99, 1.01]) * 2.0 * 1000.0 / DIAMETER)).tolist() == [False, True]

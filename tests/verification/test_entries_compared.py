"""Runs whose waves enter elsewhere, by their disks and sides, are compared as if they entered at the same time."""

from typing import Any

import numpy as np
import pytest
from small_cases import small

from dembound.results.compare import compare
from dembound.running import run_case

PERIODIC = {"type": "periodic"}
SPEED, PERIOD = 1000.0, 0.04


def ran(tmp_path: Any, name: str, diameter: float, side: str) -> Any:
    """The record of a column of a lattice under a P wave from below."""
    tables = {
        "packing": {"pattern": "A", "size": [3.0, 30.0], "radius": 0.5 * diameter},
        "material": {"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
        "boundary": {"left": PERIODIC, "right": PERIODIC, "bottom": {"type": side, "wave_p": "w"}},
        "wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
        "monitor": [{"name": "inside", "position": [0.75, 8.25]}],
        "run": {"duration": 0.05},
        "output": {"pictures": False},
    }
    return run_case(small(tables, name), tmp_path) / "run.h5"


@pytest.mark.parametrize(("side", "early"), [("velocity", 0.5), ("viscous_input", 0.25)])
def test_a_shift_by_the_radius_is_no_difference(tmp_path, side: str, early: float) -> None:
    """Motion is early by so many diameters over c: of diameters of 0.5 and 1.5 m by 1.0 m times that, δ.

    (1 − cos 2πt/T)/2 over one period T is then wrong by (πδ/T √½)/√⅜ = 2πδ/(√3 T). Without the shift the dispersion of
    the larger disks remains, which makes them late by (2πD/λ)²/24 of 7.5 m, 0.15 %, and the change of form by it.
    """
    fine, coarse = (ran(tmp_path, name, D, side) for name, D in (("fine", 0.5), ("coarse", 1.5)))
    delta = early * (1.5 - 0.5) / SPEED

    (recorded,) = compare(fine, [coarse], "velocity", as_recorded=True)
    (shifted,) = compare(fine, [coarse], "velocity")

    assert (recorded.shift, recorded.apart) == (0.0, 0.0)
    assert shifted.shift == pytest.approx(-delta, rel=0.02)
    assert recorded.rms == pytest.approx(2.0 * np.pi * delta / (np.sqrt(3.0) * PERIOD), rel=0.1)
    assert shifted.rms < 0.004

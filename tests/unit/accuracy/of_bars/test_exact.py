"""The exact motion of a bar for all its choices, beside d'Alembert's solution."""

import numpy as np
import pytest
from estimated_bars import dalembert, scene

from dembound.accuracy.of_bars.causes import ExactMotion
from dembound.bar.scene import build_bar
from dembound.formulas.bars.rods import Window


def test_it_is_known_at_the_steps_of_every_choice() -> None:
    case = scene("viscous end")
    exact = ExactMotion(build_bar(case))
    assert exact.places == pytest.approx({"near": 0.2, "far": 0.8})

    # the last step ends after the run; the first two have their samples in common
    for step in (2.1e-6, 3.7e-6, 9.1e-6):
        window = Window.up_to(case.run.duration, step)
        found = exact.at(window)
        for name, place in exact.places.items():
            for quantity in ("velocity", "displacement", "stress"):
                expected = dalembert(case, place, window.time, quantity)
                rest = np.linalg.norm(found[name].values[quantity][:, 0] - expected)
                # corners between samples, an eighth of a step h apart, differ by up to h/8 of a slope: velocities that
                # rise within 60 µs by h/16/60 µs < 0.6 %, at three of the hundreds of samples
                assert rest < 1e-3 * np.linalg.norm(expected)
    assert len(exact._found) == 2  # steps from 2⁻¹⁹ s = 1.9 µs to 2⁻¹⁸ s = 3.8 µs share it

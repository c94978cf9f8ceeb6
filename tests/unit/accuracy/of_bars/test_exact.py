"""The exact motion of a bar for all its choices, beside d'Alembert's solution."""

import numpy as np
import pytest
from estimated_bars import dalembert, scene

from dembound.accuracy.of_bars.exact import ExactMotion
from dembound.bar.scene import build_bar
from dembound.casefile.bar import BarCase
from dembound.formulas.bars.rods import Window
from dembound.kinds import with_changes


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


@pytest.mark.parametrize(
    ("place", "rise", "quantities"),
    [
        (0.97, 6e-5, {"velocity", "displacement", "stress"}),
        # with spacings of 16 mm it may be that of the end, whose stress is half a spacing inside
        (0.995, 6e-5, {"velocity", "displacement"}),
        # a push that hardly changes while waves run along the bar: its stress falls to 0 at the end, 0.01/0.8 = 1.25 %
        (0.99, 3e-2, {"velocity", "displacement"}),
    ],
)
def test_what_counts_for_all_choices(place: float, rise: float, quantities: set[str]) -> None:
    wave = {"type": "triangle", "amplitude": 1.0, "rise": rise, "fall": rise}
    changes = {"bar.spacing": 0.0005, "monitor.far.position": place, "wave.pulse": wave, "run.duration": 5e-3}
    case = with_changes(scene("finite differences, ν = 0.9"), changes)
    assert isinstance(case, BarCase)

    counted = ExactMotion(build_bar(case)).surely_counted(Window.up_to(5e-3, 4e-6))

    assert counted == {"near": {"velocity", "displacement", "stress"}, "far": quantities}

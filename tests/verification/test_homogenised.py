"""The brick predicts wave speeds and β: one static solve against dynamic runs."""

from dataclasses import dataclass

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate

PERIOD = 0.2


@dataclass(frozen=True)
class Comparison:
    """Dynamic against homogenised: wave speeds (m/s) of an unheld bar and β of its end, for one kind of wave."""

    measured_speed: float
    speed: float
    calibrated: float
    homogenised: float


def compare(lab, motion: str, radius_ratio: float, seed: int, brick: float = 10.0) -> Comparison:
    """Send a pulse along a bar one brick wide and periodic sideways, and calibrate its end."""
    boundary = {
        "left": {"type": "velocity", f"wave_{motion}": "pulse"},
        "right": "viscous",
        "bottom": "periodic",
        "top": "periodic",
    }
    length = 10 * brick
    case = lab.case(
        "B", (length, brick), held=(), boundary=boundary, wave=lab.pulse(PERIOD),
        radius_ratio=radius_ratio, seed=seed, brick=(brick, brick),
    )  # fmt: skip
    scene = build(case)
    component = 0 if motion == "p" else 1
    speed = scene.ground.wave_speeds(0)[component]
    # two sections at the same place of the brick; nothing has come back from the end before the second is passed
    places = np.array([0.5 * brick, 0.5 * brick + 0.5 * length])
    history = lab.sections(scene, places, places[1] / speed + 0.5 * PERIOD)
    measured = np.diff(places) / np.diff(history.crossing(0.25, component))
    return Comparison(
        measured_speed=float(measured[0]),
        speed=speed,
        calibrated=calibrate(case, "right", motion=motion).result,
        homogenised=calibrate(case, "right", Calibrating(method="homogenised"), motion=motion).result,
    )


def check(lab, result: Comparison) -> None:
    # a pulse of length cT on grains D: dispersion and scattering are of order (qa)²
    grain = (2.0 * np.pi * lab.diameter / (result.speed * PERIOD)) ** 2
    assert result.measured_speed == pytest.approx(result.speed, rel=grain)
    # a ratio within the calibration's 1e-3 leaves β uncertain by 2e-3
    assert result.homogenised == pytest.approx(result.calibrated, rel=2e-3 + grain)


@pytest.mark.parametrize("motion", ["p", "s"])
@pytest.mark.parametrize("radius_ratio", [1.5, 3.0])
def test_one_brick(lab, motion, radius_ratio):
    check(lab, compare(lab, motion, radius_ratio, seed=1))


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["p", "s"])
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("radius_ratio", [1.5, 2.0, 3.0])
def test_many_bricks(lab, motion, radius_ratio, seed):
    check(lab, compare(lab, motion, radius_ratio, seed, brick=20.0))

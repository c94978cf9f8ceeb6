"""Along one boundary of uneven disks the peaks of velocity are even."""

import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation
from dembound.studies.calibration import calibrate

LENGTH = {"p": 110.0, "s": 70.0}
"""At 980 and 610 m/s nothing is back from the other end within 0.22 s, when the peak has passed at 0.6 of a pulse."""
HEIGHT, PERIOD = 10.0, 0.35

SPREAD = 1.5e-3
"""Standard deviation over mean. Grains: (qa)² = 2e-4 for S, the shorter waves. Brick: its strips of a hundred disks,
each some 30 % off the mean stiffness, differ by 3 %, and over the brick's height H that tilts the wave front by at most
(qH)² = 0.09 of it for S. Together below 0.3 %, and a standard deviation is below half of that range."""


@pytest.mark.parametrize("motion", ["p", "s"])
@pytest.mark.parametrize(("side", "source"), [("right", "velocity"), ("left", "viscous_input")])
def test_spread_of_peaks(lab, side, source, motion):
    """The end that absorbs the pulse, and the one that lets it in, both calibrated."""

    def case(beta: float):
        boundary = {
            "left": {"type": source, f"wave_{motion}": "pulse"},
            "right": {"type": "viscous"},
            "bottom": "periodic",
            "top": "periodic",
        }
        boundary[side] |= {f"beta_{motion}": beta}
        size = (LENGTH[motion], HEIGHT)
        return lab.case("B", size, brick=(HEIGHT, HEIGHT), held=(), boundary=boundary, wave=lab.pulse(PERIOD))

    matched = calibrate(case(1.0), side, motion=motion).result
    scene = build(case(matched))
    component = 0 if motion == "p" else 1
    simulation = Simulation(scene, choose_step(scene)[0])
    arrival = LENGTH[motion] / scene.ground.wave_speeds(0)[component] if side == "right" else 0.0
    simulation.advance(int((arrival + 0.6 * PERIOD) / simulation.time_step))
    peaks = simulation.edge_peaks(side)[:, component, 1]
    assert peaks.std() < SPREAD * peaks.mean()
    assert peaks.mean() == pytest.approx(0.5, rel=2e-3)  # twice the calibration's tolerance

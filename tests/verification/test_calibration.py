"""Calibration: two passes find β, the ratio method needs Z's ten, and the calibrated end absorbs."""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.studies.calibration import calibrate

RANDOM = ["B", "C"]
KINDS = {
    "absorbing": ("right", {"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"}),
    "input": ("left", {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": "viscous"}),
}
SIDEWAYS = {"bottom": "periodic", "top": "periodic"}


@pytest.fixture(params=[(pattern, kind) for pattern in RANDOM for kind in KINDS], ids="-".join)
def bar(request, lab):
    """A bar of 200 m and the side to calibrate; the pulse is as long as the bar."""
    pattern, kind = request.param
    side, boundary = KINDS[kind]
    case = lab.case(pattern, (200.0, 10.0), boundary=boundary | SIDEWAYS, wave=lab.pulse(0.2), duration=0.65)
    return case, side


def test_impedance_method_needs_two_passes(bar):
    """The end is a dashpot on a bar, so one pass tells β0 and the second confirms it."""
    found = calibrate(*bar)
    assert len(found.beta) <= 2
    assert abs(found.ratio[-1] - 1.0) < 1e-3


@pytest.mark.parametrize("start", [0.5, 2.0])
@pytest.mark.parametrize("length", [40.0, 200.0])
@pytest.mark.parametrize("kind", KINDS)
def test_square_lattice_needs_no_correction(lab, kind, length, start):
    """β0 = 1 for touching equal disks, from any start, also where the pulse is longer than the scene."""
    side, boundary = KINDS[kind]
    case = lab.case("A", (length, lab.diameter), boundary=boundary, wave=lab.pulse(0.2), duration=0.65)
    found = calibrate(case, side, start=start)
    assert len(found.beta) == 2
    # the first pass solves for β0 and is off only by the half disk of mass at the end, πD/4cT = 0.2 % in quadrature
    # with the peak: its square, and a peak sampled every 2 ‰ of the pulse
    assert found.result == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("start", [0.5, 2.0])
def test_ratio_method_halves_the_error(bar, start):
    """β ← β·r with r = 2/(1 + β/β0) near β0 halves β − β0: it stays on its side, for 9 to 11 passes.

    |r − 1| = ½|1 − β/β0| starts at 0.1 to 0.5 and ends below 1e-3: 8 to 9 halvings, and as 1/β (absorbing) or β
    (input) is halved exactly, one more from the far side.
    """
    found = calibrate(*bar, method="ratio", start=start)
    steps = np.diff(found.beta)
    assert np.all(steps > 0.0) if start < found.result else np.all(steps < 0.0)
    errors = np.array(found.ratio) - 1.0
    assert np.all(errors > 0.0) or np.all(errors < 0.0)
    assert 9 <= len(found.beta) <= 11


def test_strip_stands_for_the_whole_scene(bar):
    """What the strip leaves out arrives after the peak has left the side."""
    strip, full = calibrate(*bar), calibrate(*bar, full=True)
    assert strip.particles < full.particles
    # both take β from their first pass, whose peak sees the same bricks and dashpots. The strip's pulse travels a
    # third of the way: dispersion and scattering on the way are of order (qa)² = 2.5e-4
    assert strip.result == pytest.approx(full.result, rel=1e-3)


@pytest.mark.parametrize("pattern", RANDOM)
def test_little_comes_back_from_a_calibrated_end(lab, pattern):
    """Z's P4, 250 m before the end, and his pulse: at most 0.2 % of the peak returns."""

    def case(beta: float):
        boundary = SIDEWAYS | {
            "left": {"type": "velocity", "wave_p": "pulse"},
            "right": {"type": "viscous", "beta_p": beta},
        }
        return lab.case(pattern, (500.0, 10.0), boundary=boundary, wave=lab.pulse(0.5))

    scene = build(case(calibrate(case(1.0), "right").result))
    speed = scene.ground.wave_speeds(0)[0]
    passed = 250.0 / speed + 0.5
    history = lab.sections(scene, [250.0], passed + 500.0 / speed - 0.25)  # until the grip's echo of the echo
    echo = history.velocity[history.times > passed, 0, 0] / 0.5
    # a matched end returns πΔ/2cT, Δ the thickness of the layer whose mass the dashpots carry on top of the bar's.
    # It is D/2 on a square lattice; the particles seen from outside lie in a layer of D, and Δ < D: below 0.16 %
    assert np.abs(echo).max() < np.pi * lab.diameter / (2.0 * speed * 0.5)

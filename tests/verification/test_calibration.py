"""Calibration: two passes find β, the ratio method needs Z's ten, and the calibrated end absorbs."""

from functools import cache

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate

KINDS = {
    "absorbing": ("right", {"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"}),
    "input": ("left", {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": "viscous"}),
}
SIDEWAYS = {"bottom": "periodic", "top": "periodic"}
BRICK = (10.0, 5.0)
"""Ten mean diameters across: it is periodic sideways, and the period does not affect waves along the bar."""


@pytest.fixture(scope="module", params=[("B", "absorbing"), ("C", "input")], ids="-".join)
def bar(request, lab):
    """Makes a bar and names the side to calibrate; the strip has 0.35 of the pulse's length, the bar twice that."""
    pattern, kind = request.param
    side, boundary = KINDS[kind]

    def make(period: float):
        size = (700.0 * period, BRICK[1])
        boundaries = boundary | SIDEWAYS
        return lab.case(pattern, size, brick=BRICK, boundary=boundaries, wave=lab.pulse(period)), side

    return make


@pytest.fixture(scope="module")
def calibrated(bar):
    """Calibration by a pulse of so many seconds on the strip; once for all tests."""
    return cache(lambda period: calibrate(*bar(period)))


def test_matched_factors_let_a_wave_in_or_out_as_it_is(calibrated):
    """The first pass has the default of all sides; the second confirms it, as the end is a dashpot on a bar."""
    found = calibrated(0.2)
    assert len(found.beta) == 2
    assert abs(found.ratio[-1] - 1.0) < 1e-3
    # grains scatter some (qD)² = 1e-3 of a pulse of 400 disks; half of the difference of β shows in the ratio
    assert abs(found.ratio[0] - 1.0) < 2.5e-3
    assert found.beta[0] == pytest.approx(found.result, rel=5e-3)


@pytest.mark.parametrize("start", [0.5, 2.0])
def test_ratio_method_halves_the_error(bar, start):
    """β ← β·r with r = 2/(1 + β/β0) near β0 halves β − β0: it stays on its side, for 9 to 11 passes.

    |r − 1| = ½|1 − β/β0| starts at 0.1 to 0.5 and ends below 1e-3: 8 to 9 halvings, and as 1/β (absorbing) or β
    (input) is halved exactly, one more from the far side. That is so for any pulse: for this one, of 100 m, disks
    change β0 by (qa)² = 1e-3 and the end disks' mass by (πD/4cT)² = 2e-5, without changing the halving.
    """
    found = calibrate(*bar(0.1), Calibrating(method="ratio", start=start))
    steps = np.diff(found.beta)
    assert np.all(steps > 0.0) if start < found.result else np.all(steps < 0.0)
    errors = np.array(found.ratio) - 1.0
    assert np.all(errors > 0.0) or np.all(errors < 0.0)
    assert 9 <= len(found.beta) <= 11


def test_strip_stands_for_the_whole_scene(bar, calibrated):
    """Effects of the parts outside of the strip arrive after the peak has left the side."""
    strip, full = calibrated(0.2), calibrate(*bar(0.2), Calibrating(full=True))
    assert strip.particles < full.particles
    # both take β from their first pass, whose peak sees the same bricks and dashpots. The strip's pulse travels half
    # of the way: dispersion and scattering on the way are of order (qa)² = 2.5e-4
    assert strip.result == pytest.approx(full.result, rel=1e-3)


def test_little_comes_back_from_a_calibrated_end(lab):
    """Z's P4, 250 m before the end, and his pulse: at most 0.2 % of the peak returns.

    The pulse comes in just before P4 through dashpots, which let its echo out again; they are this side's, so that what
    comes in is known to their few per cent, and measured.
    """
    length, place = 260.0, 10.0

    def case(beta: float):
        boundary = SIDEWAYS | {
            "left": {"type": "viscous_input", "wave_p": "pulse", "beta_p": beta},
            "right": {"type": "viscous", "beta_p": beta},
        }
        return lab.case("B", (length, BRICK[1]), brick=BRICK, boundary=boundary, wave=lab.pulse(0.5))

    scene = build(case(calibrate(case(1.0), "right").result))
    speed = scene.ground.wave_speeds(0)[0]
    passed = place / speed + 0.5
    # until the echo has passed, which has its crests at a quarter and three quarters of its length
    history = lab.sections(scene, [place], (2.0 * length - place) / speed + 0.5)
    velocity = history.velocity[:, 0, 0]
    echo = velocity[history.times > passed] / velocity.max()
    # a matched end returns πΔ/2cT, Δ the thickness of the layer whose mass the dashpots carry on top of the bar's.
    # It is D/2 on a square lattice; the particles seen from outside lie in a layer of D, and Δ < D: below 0.16 %
    assert np.abs(echo).max() < np.pi * lab.diameter / (2.0 * speed * 0.5)

"""A shear pulse along a bar that is periodic sideways: the same end, with β_S."""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.studies.calibration import calibrate

PERIOD, LENGTH = 0.2, 200.0
PLACES = (55.0, 105.0, 155.0)  # the same place of a brick each time


@pytest.fixture(scope="module", params=["A", "B"])
def bar(request, lab):
    """Pattern, shear wave speed, calibration and sections of a bar with calibrated end."""

    def case(beta: float):
        boundary = {
            "left": {"type": "velocity", "wave_s": "pulse"},
            "right": {"type": "viscous", "beta_s": beta},
            "bottom": "periodic",
            "top": "periodic",
        }
        height = lab.diameter if request.param == "A" else 10.0
        return lab.case(request.param, (LENGTH, height), held=(), boundary=boundary, wave=lab.pulse(PERIOD))

    found = calibrate(case(1.0), "right", motion="s")
    scene = build(case(found.result))
    speed = scene.ground.wave_speeds(0)[1]
    # until the whole echo has come back to the last place
    history = lab.sections(scene, PLACES, (2.0 * LENGTH - PLACES[-1]) / speed + PERIOD)
    return request.param, speed, found, history


def grain(lab, speed):
    """(qa)² of the pulse's main wave: the order of dispersion, scattering and loss to other motions."""
    return (2.0 * np.pi * lab.diameter / (speed * PERIOD)) ** 2


def test_travels_at_the_homogenised_speed(lab, bar):
    _, speed, _, history = bar
    measured = np.diff(PLACES) / np.diff(history.crossing(0.25, component=1))
    np.testing.assert_allclose(measured, speed, rtol=grain(lab, speed))


def test_peak_is_kept(lab, bar):
    _, speed, _, history = bar
    np.testing.assert_allclose(history.velocity[:, :, 1].max(axis=0), 0.5, rtol=grain(lab, speed))


def test_calibrates_like_p(bar):
    pattern, _, found, _ = bar
    assert abs(found.ratio[-1] - 1.0) < 1e-3
    assert len(found.beta) == (1 if pattern == "A" else 2)  # A has ΣD = H and its dashpots' own speed: β = 1


def test_reflection(lab, bar):
    """The end returns (x/2c)·dv/dt with x the thickness of the layer that is missing or too much."""
    pattern, speed, _, history = bar
    passed = PLACES[-1] / speed + PERIOD
    # the echo's steepest part is due a quarter of a pulse after its start
    echo = np.abs(history.velocity[history.times > passed + PERIOD / 8.0, -1, 1]).max() / 0.5
    unit = np.pi * lab.diameter / (4.0 * speed * PERIOD)
    if pattern == "B":
        # the particles seen from outside lie in a layer of one diameter, twice that of the square lattice
        assert echo < 2.0 * unit
        return
    # Square lattice: half a disk too much mass, as for P, and an end disk that only one bond turns. With φ the
    # excess rotation over that of the bar, θ = F/k_sD under a force F per row, and κ = k_r/k_sD² (1/12 for bonds of
    # full radius that alone carry shear) balance of moments reads φ = κ(φ₊ + φ₋ − 2φ): φ falls by λ from disk to
    # disk, λ + 1/λ = 2 + 1/κ; the end disk has φ(1 + κ(1 − λ)) = −θ/2. The end is stiffer by
    # (D/2)(θ + φ_end) = (F/2k_s)(1 − ½/(1 + κ(1 − λ))), which reflects as that share d of k_s does: 1 + d in all
    kappa = 1.0 / 12.0
    decay = (1.0 + 0.5 / kappa) - np.sqrt((1.0 + 0.5 / kappa) ** 2 - 1.0)
    stiffer = 0.5 * (1.0 - 0.5 / (1.0 + kappa * (1.0 - decay)))
    assert echo == pytest.approx((1.0 + stiffer) * unit, rel=0.01)

"""The incident wave below level ground whose surface is given."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from dembound.errors import CaseError
from dembound.exact.column import Column, ColumnMotion, Layer
from dembound.kinds.disks.incident_wave import Level, OfMotionWithin
from dembound.studies.deconvolution import incident_below, level_ground
from dembound.waves import Ricker
from tests.small_cases import PUSHED, small

STEP = 0.005
SURFACE = np.exp(-(((STEP * np.arange(400) - 1.0) / 0.06) ** 2))
"""A pulse of 1 m/s up to 10 Hz."""


@pytest.mark.parametrize("alpha", [3.0, 0.4])
def test_it_moves_the_surface_as_given(alpha: float) -> None:
    """Of stiffer rock at most half of the surface's amplitude comes in, of softer one up to half over α."""
    found = incident_below(Level((Layer(29.0, 1900.0, 210.0),), alpha), SURFACE, STEP)
    column = Column([Layer(29.0, 1900.0, 210.0), Layer(1.0, 1900.0, alpha * 210.0)])
    delayed = np.concatenate([np.zeros(round(found.early / STEP)), SURFACE])
    assert np.abs(column.history(found.velocity, STEP) - delayed).max() < 1e-6
    assert found.magnification == pytest.approx(0.5 * max(1.0, 1.0 / alpha), rel=1e-2)
    assert f"up to {found.magnification:.3g} times" in found.sentence


def relaxed(frequency: np.ndarray) -> np.ndarray:
    """M(ω)/M₀ of three mechanisms, Q = 20."""
    weights, times = np.array([0.0641, 0.0472, 0.0749]), np.array([0.56, 0.0917, 0.0146])
    return 1.107 * (1.0 - np.sum(weights / (1.0 + 2j * np.pi * frequency[..., None] * times), axis=-1))


SOFT, STIFF = Layer(30.0, 1800.0, 200.0), Layer(40.0, 2000.0, 350.0, 20.0, relaxed)


@pytest.mark.parametrize("modulus", ["as_run", "constant_q"])
@pytest.mark.parametrize("alpha", [3.0, None])
def test_damped_layers_move_the_surface_as_given(alpha: float | None, modulus) -> None:
    """On rock, and where the damped layer goes on below."""
    ground = Level((SOFT, STIFF), alpha)
    found = incident_below(ground, SURFACE, STEP, modulus=modulus)
    assert found.early >= 30.0 / 200.0 + 40.0 / 350.0
    column, delayed = (
        ground.column(modulus, on_rock=True),
        np.concatenate([np.zeros(round(found.early / STEP)), SURFACE]),
    )
    incident = ColumnMotion(column, CubicSpline(STEP * np.arange(len(found.velocity)), found.velocity), 70.0, 0.0, 1.9)
    times = STEP * np.arange(380)
    assert (
        np.abs(incident.at("velocity", times, (0.0,))[:, 0] - delayed[:380]).max() < 1e-4
    )  # beyond the band it is limited


def test_noise_beyond_the_band_of_the_record_is_not_magnified() -> None:
    """Weak waves of 60 Hz, which this ground has a hundred times as large below as at the surface."""
    ground = Level((Layer(100.0, 1800.0, 200.0, 20.0, relaxed),), 3.0)
    noise = 1e-4 * np.sin(2.0 * np.pi * 60.0 * STEP * np.arange(len(SURFACE)))
    clean, noisy = (incident_below(ground, each, STEP) for each in (SURFACE, SURFACE + noise))
    assert noisy.is_limited
    assert "and is magnified by no more" in noisy.sentence
    assert np.abs(noisy.velocity - clean.velocity).max() < 1.03e-4 * noisy.magnification
    assert not incident_below(Level((SOFT, Layer(40.0, 2000.0, 350.0)), 3.0), SURFACE, STEP).is_limited


def test_the_motion_within_layers_gives_the_incident_wave() -> None:
    """As for uniform ground by echoes; and in damped layers it moves their base as given."""
    wave = Ricker(type="ricker", amplitude=1.0, frequency=4.0, start=0.1)
    times = np.linspace(0.0, 1.5, 400)
    uniform = Level((Layer(70.0, 1800.0, 200.0),), 3.0, 0.2, 0.4)
    halves = Level((replace(SOFT, thickness=30.0), replace(SOFT, thickness=40.0)), 3.0, 0.2, 0.4)
    for of in ("velocity", "displacement"):
        expected, found = (getattr(OfMotionWithin(wave, ground, 1.5), of)(times) for ground in (uniform, halves))
        assert np.abs(found - expected).max() < 1e-5 * np.abs(expected).max()
    damped = Level((SOFT, STIFF), 3.0)
    incident = OfMotionWithin(wave, damped, 1.5)
    moved = ColumnMotion(damped.column(on_rock=True), incident.velocity, 70.0, 0.0, 1.5)
    assert np.abs(moved.at("velocity", times, (70.0,))[:, 0] - wave.velocity(times)).max() < 1e-5


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({}, "boundary.bottom: must absorb and name a wave_p or wave_s"),
        ({"boundary.bottom": {"type": "velocity", "wave_s": "push"}}, "boundary.bottom: must absorb"),
        ({"boundary.top": {"type": "viscous"}}, "needs a free surface at the top"),
    ],
)
def test_ground_without_an_answer_is_refused(changes: dict, message: str) -> None:
    case = small(PUSHED, changes={"boundary.right": {"type": "free"}} | changes)
    with pytest.raises(CaseError, match=message):
        level_ground(case)

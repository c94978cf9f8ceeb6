"""d'Alembert's bar against the wave equation and its ends, and its spall against a search over place and time."""

import numpy as np
import pytest

from dembound.exact import bar_stress, bar_velocity, triangle_spall
from dembound.exact.bar import End

LENGTH, SPEED, IMPEDANCE = 3.0, 2000.0, 5e6
WAIT = LENGTH / SPEED
CREST = 12e6


def bump(time: np.ndarray) -> np.ndarray:
    """A smooth pulse of 0.6 ms."""
    return CREST * np.where((time > 0.0) & (time < 6e-4), np.sin(np.pi * time / 6e-4) ** 4, 0.0)


def triangle(rise: float, fall: float):
    return lambda time: np.interp(time, [0.0, rise, rise + fall], [0.0, CREST, 0.0], left=0.0, right=0.0)


def both(place: float, time: np.ndarray, far_end: End) -> tuple[np.ndarray, np.ndarray]:
    return (
        bar_stress(place, time, bump, LENGTH, SPEED, far_end),
        bar_velocity(place, time, bump, LENGTH, SPEED, IMPEDANCE, far_end),
    )


@pytest.mark.parametrize("far_end", ["free", "fixed"])
def test_momentum_and_stiffness_are_kept(far_end: End) -> None:
    """ρ∂v/∂t = ∂σ/∂x and ∂σ/∂t = ρc²∂v/∂x, in central differences.

    Those are off by h²/6 of the third derivatives, which of sin⁴ ωt = ⅜ − ½cos 2ωt + ⅛cos 4ωt are at
    most 12ω³, ω = π/t_0. Two passages at most meet, and both sides have such an error.
    """
    step = 1e-7
    time = np.linspace(2e-4, 5.3 * WAIT, 500)
    bound = 2.0 * step**2 / 6.0 * 12.0 * (np.pi / 6e-4) ** 3 * 2.0 * CREST
    for place in (0.4, 1.5, 2.9):
        (left, right), (before, after) = (
            [both(place + d * SPEED, time, far_end) for d in (-step, step)],
            [both(place, time + d, far_end) for d in (-step, step)],
        )
        stress, velocity = ((b - a) / (2.0 * step) for a, b in zip(left, right, strict=True))
        stress_rate, velocity_rate = ((b - a) / (2.0 * step) for a, b in zip(before, after, strict=True))
        np.testing.assert_allclose(IMPEDANCE * velocity_rate, stress, rtol=0, atol=bound)
        np.testing.assert_allclose(stress_rate, IMPEDANCE * velocity, rtol=0, atol=bound)


@pytest.mark.parametrize(
    ("rise", "fall", "share"), [(0.2e-3, 0.5e-3, 0.1), (0.4e-3, 0.3e-3, 0.55), (0.5e-3, 0.05e-3, 0.95)]
)
def test_spall_is_the_first_place_at_its_strength(rise: float, fall: float, share: float) -> None:
    """A search in steps of 0.4 µs, and of the way h of a wave in one, until some steps after the moment expected.

    A place within h of the first one follows it within a step, and is seen within another: two steps late. Until then
    tension may have gone 4h times a slope of the pulse beyond the strength, and it is reached that much over the
    difference of both slopes farther: in all within 2h + 4h·min/|t_f − t_r|, less than four times max/|t_f − t_r|.
    """
    step = 4e-7
    place, moment = triangle_spall(LENGTH, SPEED, rise, fall, CREST, share * CREST)
    time = np.arange(0.9 * WAIT, moment + 5.0 * step, step)
    places = np.arange(0.0, LENGTH, step * SPEED)[-1250:]
    stress = np.array([bar_stress(x, time, triangle(rise, fall), LENGTH, SPEED) for x in places])
    reached = stress >= share * CREST * (1.0 - 1e-9)  # but for rounding
    assert reached.any()
    first = np.argmax(reached.any(axis=0))
    apart = max(rise, fall) / abs(rise - fall)
    assert time[first] == pytest.approx(moment, abs=2.0 * step)
    assert np.abs(places[reached[:, first]] - place).max() <= 4.0 * apart * step * SPEED


@pytest.mark.parametrize("strength", [0.0, 1.001 * CREST])
def test_a_crest_below_the_strength_breaks_nothing(strength: float) -> None:
    with pytest.raises(ValueError, match="strength"):
        triangle_spall(LENGTH, SPEED, 1e-4, 1e-4, CREST, strength)


@pytest.mark.parametrize("far_end", ["free", "fixed"])
def test_ends_do_what_they_are_to(far_end: End) -> None:
    early = both(1.2, np.array([0.0, 0.99, 1.0]) * 1.2 / SPEED, far_end)
    assert not np.any(early)  # nothing comes before the wave does
    time = np.linspace(0.0, 6.0 * WAIT, 1000)
    rounding = 6 * np.finfo(float).eps * 4.0 * np.pi * 6.0 * WAIT / 6e-4 * CREST  # of the times of six passages
    np.testing.assert_allclose(both(0.0, time, far_end)[0], -bump(time), rtol=0, atol=rounding)
    stress, velocity = both(LENGTH, time, far_end)
    if far_end == "free":
        np.testing.assert_allclose(stress, 0.0, rtol=0, atol=rounding)
        assert velocity.max() == pytest.approx(2.0 * CREST / IMPEDANCE, rel=1e-3)
    else:
        np.testing.assert_allclose(velocity, 0.0, rtol=0, atol=rounding / IMPEDANCE)
        assert stress.min() == pytest.approx(-2.0 * CREST, rel=1e-3)

"""Histories at other times: smooth ones by cubics, jumps without overshoot."""

import numpy as np
import pytest

from dembound.results.compare import at_times

REQUESTED = np.sort(np.random.default_rng(0).uniform(0.0, 10.0, 5000))


def error(motion, samples: int) -> tuple[float, float, float]:
    """RMS over RMS of the error of `samples` a second, that by straight lines, and the largest value found."""
    time = np.linspace(0.0, 10.0, 10 * samples + 1)
    found, expected = at_times(time, motion(time), REQUESTED), motion(REQUESTED)
    straight = np.interp(REQUESTED, time, motion(time))
    by_cubics, by_lines = (float(np.linalg.norm(each - expected)) for each in (found, straight))
    return by_cubics / np.linalg.norm(expected), by_lines / np.linalg.norm(expected), float(found.max())


@pytest.mark.parametrize("samples", [5, 20])
def test_sines_have_the_error_of_a_spline(samples: int) -> None:
    # a cubic spline errs by h⁴f⁗/384 at most, (2π/n)⁴/384 of a sine; at its ends, of f⁗h⁴ times 9/384, twice in 10
    # periods of n intervals; RMS over RMS of a sine √2 of it where it errs alike everywhere
    found, straight, _ = error(lambda time: np.sin(2.0 * np.pi * time + 0.3), samples)
    assert found < 2.5 * (2.0 * np.pi / samples) ** 4 / 384.0
    assert found < 0.12 * straight


JUMPS = {
    "step": lambda time: 1.0 * (time > 3.03),
    "sine that jumps to another": lambda t: np.where(t < 5.03, np.sin(2 * np.pi * t), 1.5 + np.sin(4 * np.pi * t)),
}


@pytest.mark.parametrize("name", JUMPS)
def test_a_jump_is_crossed_straight(name: str) -> None:
    """Where the motion jumps between two samples nothing is known, and nothing rings beside it."""
    found, straight, largest = error(JUMPS[name], 20)
    assert found <= straight * (1.0 + 1e-12)
    assert largest <= max(JUMPS[name](REQUESTED)) * (1.0 + 1e-3)


def test_samples_are_kept_and_ends_go_on() -> None:
    time, values = np.linspace(0.0, 1.0, 11), np.random.default_rng(1).standard_normal((11, 2))
    assert at_times(time, values, time) is values
    np.testing.assert_allclose(at_times(time, values, time[2:7] + 1e-15), values[2:7], atol=1e-13)
    np.testing.assert_allclose(at_times(time, values, np.array([-1.0, 2.0])), values[[0, -1]], atol=1e-13)

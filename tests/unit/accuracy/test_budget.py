"""Causes together: totals, bands, corrections, texts."""

import numpy as np
import pytest

from dembound.accuracy.budget import Estimate
from dembound.accuracy.cause import SIDES, Cause, Causes
from dembound.accuracy.history import History

TIME = np.linspace(0.0, 1.0, 5)
MOTION = np.array([[0.0, 0.0], [1.0, 3.0], [-1.0, 4.0], [2.0, 0.0], [0.0, 0.0]])
"""The RMS along y, the larger component, is that of (3, 4): errors are over 5."""


def estimate(echo_free: bool = True) -> Estimate:
    """Sides that add a constant of 1 along x and −2 along y; a grid of which only the size is known."""
    recorded = {"a": History(np.zeros(2), TIME, {"velocity": MOTION})}
    added = np.tile([1.0, -2.0], (5, 1))
    sides = Cause(SIDES, "from a pair", {"a": {"velocity": added}})
    grid = Cause("grid", "by formula", {"a": {"velocity": 0.25}})
    return Estimate(recorded, Causes([sides], echo_free=echo_free) + Causes([grid], ["x"], ["y"], 0.1))


def test_shares_are_those_of_the_larger_component_and_add_as_squares():
    found = estimate()
    sides = 2.0 * 5**0.5 / 5.0
    assert found.shares("a", "velocity") == {SIDES: pytest.approx(sides), "grid": 0.25}
    assert found.total("a", "velocity") == pytest.approx(np.hypot(sides, 0.25))
    # bands add the sizes of all errors; corrections need a scene without echoes
    size = 0.25 * np.sqrt(np.mean(MOTION**2, axis=0))
    np.testing.assert_allclose(found.band("a", "velocity"), np.tile(np.add([1.0, 2.0], size), (5, 1)))
    np.testing.assert_array_equal(found.correction("a", "velocity"), np.tile([1.0, -2.0], (5, 1)))
    assert estimate(echo_free=False).correction("a", "velocity") is None


def test_lines_begin_with_the_errors_and_end_with_what_is_missing():
    assert estimate().lines() == [
        "error at a, in part: velocity 93 % (sides 89 %, grid 25 %)",
        "sides from a pair",
        "grid by formula",
        "y",
        "not estimated: x",
    ]
    # causes found alike share a line
    recorded = {"a": History(np.zeros(2), TIME, {"velocity": MOTION})}
    two = [Cause(name, "by formula", {"a": {"velocity": 0.03}}) for name in ("grid", "time step")]
    assert Estimate(recorded, Causes(two)).lines()[1:] == ["grid and time step by formula"]


def test_a_monitor_at_rest_has_no_error():
    recorded = {"a": History(np.zeros(2), TIME, {"velocity": np.zeros((5, 2))})}
    cause = Cause(SIDES, "from a pair", {"a": {"velocity": np.zeros((5, 2))}})
    found = Estimate(recorded, Causes([cause]))
    assert found.shares("a", "velocity") == {}
    assert found.summary()["monitors"] == {"a": {}}
    assert found.lines() == ["sides from a pair"]

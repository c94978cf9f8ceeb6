"""Sums of causes: totals relative to disks and rock, upper bounds, bands, corrections, texts."""

import numpy as np
import pytest

from dembound.accuracy.budget import Budget
from dembound.accuracy.table import WHAT, lines_of
from dembound.formulas.cause import SIDES, Cause, Causes
from dembound.formulas.history import History

TIME = np.linspace(0.0, 1.0, 5)
MOTION = np.array([[0.0, 0.0], [1.0, 3.0], [-1.0, 4.0], [2.0, 0.0], [0.0, 0.0]])
"""The RMS along y, the larger component, is that of (3, 4): errors are over 5."""

SIZE = 2.0 * 5**0.5 / 5.0
"""Share of sides that add a constant of 1 along x and −2 along y."""

ADDED = np.tile([1.0, -2.0], (5, 1))


def budget(*more: Cause, echo_free: bool = True) -> Budget:
    """Sides, and a grid of which only the size is known."""
    recorded = {"a": History(np.zeros(2), TIME, {"velocity": MOTION})}
    sides = Cause(SIDES, "from companions", {"a": {"velocity": ADDED}}, "companion", factor=1.5)
    grid = Cause("grid", "by formula", {"a": {"velocity": 0.25}}, of_disks=True, factor=3.0)
    return Budget(recorded, Causes([sides, *more], echo_free=echo_free) + Causes([grid], ["x"], ["y"], 0.1))


def test_shares_are_those_of_the_larger_component_and_add_as_squares():
    found = budget()
    assert found.shares("a", "velocity") == {SIDES: pytest.approx(SIZE), "grid": 0.25}
    rock, disks = found.total("a", "velocity", "rock"), found.total("a", "velocity", "disks")
    assert rock.value == pytest.approx(np.hypot(SIZE, 0.25))
    assert rock.upper == pytest.approx(rock.value + np.hypot(0.5 * SIZE, 2.0 * 0.25))
    assert (disks.value, disks.upper) == (pytest.approx(SIZE), pytest.approx(1.5 * SIZE))
    # bands add the sizes of all errors; corrections need a scene without echoes
    size = 0.25 * np.sqrt(np.mean(MOTION**2, axis=0))
    np.testing.assert_allclose(found.band("a", "velocity"), np.tile(np.add([1.0, 2.0], size), (5, 1)))
    np.testing.assert_array_equal(found.correction("a", "velocity"), ADDED)
    assert budget(echo_free=False).correction("a", "velocity") is None


def test_histories_keep_their_signs_bounds_are_only_in_the_upper_value_and_what_is_unknown_is_said():
    against = Cause("entry", "from companions", {"a": {"velocity": -0.75 * ADDED}}, "companion", factor=1.5)
    found = budget(against).total("a", "velocity", "disks")
    assert (found.value, found.upper) == (pytest.approx(0.25 * SIZE), pytest.approx(0.25 * 1.5 * SIZE))
    bound = Cause("law", "by a bound", {"a": {"velocity": 0.3}}, "bound")
    found = budget(bound).total("a", "velocity", "disks")
    assert (found.value, found.upper) == (pytest.approx(SIZE), pytest.approx(SIZE + np.hypot(0.5 * SIZE, 0.3)))
    found = budget(Cause.unknown("edge", "single disks", of_disks=True))
    assert found.total("a", "velocity", "rock").at_least
    assert str(found.total("a", "velocity", "rock")).startswith(">= ")
    assert str(found.total("a", "velocity", "rock")).endswith(" %, at most ?")
    assert not found.total("a", "velocity", "disks").at_least


def test_the_worst_is_at_a_monitor_that_moves():
    quiet = History(np.zeros(2), TIME, {"velocity": 0.001 * MOTION})
    loud = budget()
    found = Budget({**loud.motions, "quiet": quiet}, Causes([Cause("x", "", {"quiet": {"velocity": 0.9}})]))
    assert found.worst().share.value == 0.0
    assert loud.worst("disks").by == {SIDES: pytest.approx(SIZE)}
    assert (loud.worst().monitor, loud.worst().quantity) == ("a", "velocity")


def test_a_stress_that_vanishes_at_a_free_end_is_not_named() -> None:
    def motion(velocity: float, stress: float) -> History:
        along = np.sin(TIME)[:, None]
        return History(np.zeros(2), TIME, {"velocity": velocity * along, "stress": stress * along})

    errors = {"middle": {"velocity": 0.01, "stress": 0.01}, "end": {"velocity": 0.02, "stress": 0.5}}
    found = Budget({"middle": motion(1.0, 1e6), "end": motion(2.0, 0.09e6)}, Causes([Cause("grid", "", errors)]))
    assert found.largest("end")[0] == "velocity"
    assert str(found.worst()) == "2 %, at most 2 % of the velocity at end (grid 2 %)"


def budget_of(causes, names=("P1", "surface")) -> Budget:
    """A budget of causes with these sizes at all monitors."""
    motion = History(np.zeros(2), TIME, {"velocity": np.ones((5, 2)), "displacement": np.ones((5, 2))})
    made = [
        Cause(name, words, {each: {"velocity": size, "displacement": 0.5 * size} for each in names}, how, of_disks, 1.4)
        for name, words, size, how, of_disks in causes
    ]
    return Budget(dict.fromkeys(names, motion), Causes(made, ["motion after 3 s"], ["a note"]))


def test_every_monitor_has_a_row_and_each_truth_a_total():
    walls = ("walls of holes", "by the disks along the radius", 0.07, "formula", True)
    found = budget_of([("sides", "from companions", 0.041, "companion", False), walls])
    assert lines_of(found) == [
        WHAT,
        "                these  walls of",
        "monitor  sides  disks     holes  the rock  at most",
        "P1       4.1 %  4.1 %       7 %     8.1 %     11 %",
        "surface  4.1 %  4.1 %       7 %     8.1 %     11 %",
        "sides: from companions",
        "walls of holes: by the disks along the radius",
        "a note",
        "not estimated: motion after 3 s",
    ]

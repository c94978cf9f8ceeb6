"""A budget as a table: rows, columns that fit, totals of both truths, and what is not known."""

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.cause import Cause, Causes
from dembound.accuracy.history import History
from dembound.accuracy.table import WHAT, WIDTH, lines_of

TIME = np.linspace(0.0, 1.0, 5)


def budget(causes, names=("P1", "surface")) -> Budget:
    """A budget of causes with these sizes at all monitors."""
    motion = History(np.zeros(2), TIME, {"velocity": np.ones((5, 2)), "displacement": np.ones((5, 2))})
    made = [
        Cause(name, words, {each: {"velocity": size, "displacement": 0.5 * size} for each in names}, how, of_disks, 1.4)
        for name, words, size, how, of_disks in causes
    ]
    return Budget(dict.fromkeys(names, motion), Causes(made, ["motion after 3 s"], ["a note"]))


def test_every_cause_has_a_row_and_each_truth_a_total():
    walls = ("walls", "by the disks along the radius", 0.07, "formula", True)
    found = budget([("sides", "from companions", 0.041, "companion", False), walls])
    assert lines_of(found) == [
        WHAT,
        "how wrong is it     P1  surface  known by",
        "  sides          4.1 %    4.1 %  companion",
        "of these disks   4.1 %    4.1 %  at most 5.7 %",
        "  walls            7 %      7 %  formula",
        "of the rock      8.1 %    8.1 %  at most 11 %",
        "sides: from companions",
        "walls: by the disks along the radius",
        "a note",
        "not estimated: motion after 3 s",
    ]


def test_bounds_and_what_is_unknown_are_marked():
    bound = ("law", "by a bound", 0.3, "bound", False)
    found = lines_of(budget([("sides", "why not", float("nan"), "unknown", False), bound], ["a"]))
    assert found[1:5] == [
        "how wrong is it        a  known by",
        "  sides                ?  unknown",
        "  law            <= 30 %  bound",
        "of the rock            ?  at least",
    ]


def test_lines_fit_a_terminal_and_monitors_that_do_not_are_counted():
    names = [f"monitor_{k}" for k in range(12)]
    found = lines_of(budget([("sides", "a sentence " * 20, 0.02, "companion", False)], names))
    assert max(map(len, found)) <= WIDTH
    assert "and 8 more monitors, at most 2.8 %" in found
    assert lines_of(Budget({}, Causes([], ["has no monitor"]))) == ["not estimated: has no monitor"]

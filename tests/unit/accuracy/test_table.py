"""A budget as a table: rows, columns that fit, totals of both truths, and what is not known."""

from pathlib import Path

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.table import WHAT, WIDTH, lines_of, next_step
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import History

TIME = np.linspace(0.0, 1.0, 5)


def budget(causes, names=("P1", "surface")) -> Budget:
    """A budget of causes with these sizes at all monitors."""
    motion = History(np.zeros(2), TIME, {"velocity": np.ones((5, 2)), "displacement": np.ones((5, 2))})
    made = [
        Cause(name, words, {each: {"velocity": size, "displacement": 0.5 * size} for each in names}, how, of_disks, 1.4)
        for name, words, size, how, of_disks in causes
    ]
    return Budget(dict.fromkeys(names, motion), Causes(made, ["motion after 3 s"], ["a note"]))


def test_every_monitor_has_a_row_and_each_truth_a_total():
    walls = ("walls of holes", "by the disks along the radius", 0.07, "formula", True)
    found = budget([("sides", "from companions", 0.041, "companion", False), walls])
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


def test_bounds_and_what_is_unknown_are_marked():
    bound = ("law", "by a bound", 0.3, "bound", False)
    found = lines_of(budget([("sides", "why not", float("nan"), "unknown", False), bound], ["a"]))
    assert found[1:4] == ["monitor      law  whole  at most", "a        <= 30 %      ?        ?", "law: by a bound"]
    assert "not estimated: sides, why not" in found


def test_lines_fit_a_terminal_and_monitors_that_do_not_are_counted():
    names = [f"monitor_{k}" for k in range(12)]
    found = lines_of(budget([("sides", "a sentence " * 20, 0.02, "companion", False)], names))
    assert max(map(len, found)) <= WIDTH
    assert "and 2 more monitors, at most 2.8 %" in found
    assert lines_of(Budget({}, Causes([], ["has no monitor"]))) == ["not estimated: has no monitor"]
    small = [(f"cause number {k}", "words", 1e-5, "formula", k > 5) for k in range(9)]
    found = lines_of(budget([("sides", "words", 0.02, "companion", False), *small]))
    assert max(map(len, found)) <= WIDTH
    assert any(line.startswith("< 0.1 % at all monitors: cause number 0, cause number 1") for line in found)


def test_what_to_do_next_names_the_largest_cause_where_the_error_is_large():
    folder, case = Path("results/my run"), Path("run.toml")
    found = budget([("sides", "words", 0.02, "companion", False), ("grid", "words", 0.03, "formula", False)])
    said = "next: most is by grid, at P1; less with dembound advise"
    assert next_step(found, folder, case) == f"{said} run.toml --error 1%"
    assert next_step(found, folder, None) == f"{said} CASE --error 1%"
    assert "error is below 1 %" in next_step(budget([("sides", "words", 0.007, "formula", False)]), folder, case)
    assert next_step(Budget({}, Causes([])), folder, case) == "next: dembound report 'results/my run'"

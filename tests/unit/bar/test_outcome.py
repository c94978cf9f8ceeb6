"""What a run of a bar ends by telling."""

import pytest

from dembound.bar.outcome import bar_outcome


def test_a_spall_of_one_node_has_one_place() -> None:
    places = [[0.906, 0.909], [1.0, 1.0]]
    summary = {
        "laws": [{"law": "peridynamics, m = 3", "from": 0.0}],
        "spalls": [{"start": place, "time": 4.393e-4} for place in places],
        "breaks_at_ends": {},
        "spalls_note": "they multiply",
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "outside": 1.0, "relative_error": 0.0},
    }
    assert bar_outcome(summary) == ["spall at 0.906–0.909 m, 0.4393 ms", "spall at 1 m, 0.4393 ms", "they multiply"]


@pytest.mark.parametrize(("count", "told", "last"), [(3, 3, "spall at"), (4, 4, "and 1 more"), (12, 4, "and 9 more")])
def test_of_many_spalls_the_first_are_told(count: int, told: int, last: str) -> None:
    summary = {
        "laws": [{"law": "finite differences", "from": 0.0}],
        "spalls": [{"start": [0.1 * n, 0.1 * n], "time": 1e-3} for n in range(count)],
        "breaks_at_ends": {},
        "spalls_note": None,
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "outside": 1.0, "relative_error": 0.0},
    }
    facts = bar_outcome(summary)
    assert facts[:3] == [f"spall at {place} m, 1.0000 ms" for place in ("0", "0.1", "0.2")]
    assert len(facts) == told
    assert facts[-1].startswith(last)


def test_a_bar_that_comes_off_an_end_that_holds_it_has_not_spalled() -> None:
    summary = {
        "laws": [{"law": "finite differences", "from": 0.0}],
        "spalls": [],
        "breaks_at_ends": {"right": {"start": [1.99, 2.0], "end": [1.99, 2.0], "time": 7.41e-4}},
        "boundaries": {"left": {"type": "free"}, "right": {"type": "fixed"}},
        "spalls_note": None,
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "outside": 1.0, "relative_error": 0.0},
    }
    assert bar_outcome(summary) == ["broke at the right end (fixed), 0.7410 ms"]

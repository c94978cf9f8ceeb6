"""Results of a run of a bar in words."""

import pytest

from dembound.kinds.bar.summary import bar_outcome


def outcome(spalls: list[dict], note: str | None = None, **more) -> list[str]:
    summary = {
        "laws": [{"law": "finite differences", "from": 0.0}],
        "spalls": spalls,
        "breaks_at_ends": {},
        "spalls_note": note,
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "supplied": 1.0, "relative_error": 0.0},
    }
    return bar_outcome(summary | more)


@pytest.mark.parametrize(("count", "lines", "last"), [(3, 3, "spall at"), (4, 4, "and 1 more"), (12, 4, "and 9 more")])
def test_of_many_spalls_the_first_are_reported(count: int, lines: int, last: str) -> None:
    facts = outcome([{"start": [0.1 * n, 0.1 * n], "time": 1e-3} for n in range(count)])
    assert facts[:3] == [f"spall at {place} m, 1 ms" for place in ("0", "0.1", "0.2")]
    assert len(facts) == lines
    assert facts[-1].startswith(last)


def test_a_bar_that_comes_off_an_end_that_holds_it_has_not_spalled() -> None:
    off = {"right": {"start": [1.99, 2.0], "end": [1.99, 2.0], "time": 7.41e-4}}
    ends = {"left": {"type": "free"}, "right": {"type": "fixed"}}
    assert outcome([], breaks_at_ends=off, boundaries=ends) == ["broke at the right end (fixed), 741 µs"]


@pytest.mark.parametrize(
    ("supplied", "said"), [(40.0, "5 % of the supplied energy"), (0.0, "energy though none came in")]
)
def test_energy_added_by_breaks_is_a_share_of_what_was_supplied_if_anything_was(supplied: float, said: str) -> None:
    (_, line) = outcome([], energy={"crack": -2.0, "supplied": supplied, "relative_error": 0.0})
    assert line == f"bonds broke within single steps, adding {said}, take a smaller bar.spacing or run.courant"

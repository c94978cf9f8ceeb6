"""Choices of the table [chart] of a case."""

import pytest

from dembound.accuracy.chart.choices import from_table
from dembound.errors import CaseError


def test_the_table_gives_choices(bar) -> None:
    case = bar(
        {
            "chart": {
                "vary": {"run.safety": [0.5, 0.9]},
                "choice": [{"name": "free", "set": {"boundary.right": {"type": "free"}}}],
            }
        }
    )
    assert from_table(case) == {
        "safety 0.5": {"run.safety": 0.5},
        "safety 0.9": {"run.safety": 0.9},
        "free": {"boundary.right": {"type": "free"}},
    }
    assert from_table(bar()) == {}


def test_two_choices_of_the_table_cannot_have_one_name(bar) -> None:
    twice = [{"name": "free", "set": {}}, {"name": "free", "set": {"run.safety": 0.5}}]
    with pytest.raises(CaseError, match=r"chart.choice: two choices have the name free"):
        from_table(bar({"chart": {"choice": twice}}))

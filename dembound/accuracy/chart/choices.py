"""The choices of a chart: from the table ``[chart]`` of a case, or else suggested by its kind of body."""

from collections.abc import Mapping
from typing import Any

from dembound.accuracy.choice import combinations
from dembound.accuracy.judges import judge_of
from dembound.casefile import Case
from dembound.errors import CaseError


def from_table(case: Case) -> dict[str, Mapping[str, Any]]:
    """The choices of the case's [chart] table by name; none without one."""
    table = case.chart
    found: dict[str, Mapping[str, Any]] = {**combinations(case, table.vary)} if table.vary else {}
    for choice in table.choice:
        if choice.name in found:
            raise CaseError([f"chart.choice: two choices have the name {choice.name}"], case.name)
        found[choice.name] = choice.set
    return found


def defaults(case: Case) -> dict[str, dict[str, Any]]:
    """Changes of keys by the name of the choice, for a case and a command that give none."""
    return dict(judge_of(case).chart_choices(case))

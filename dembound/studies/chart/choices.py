"""The choices of a chart that the table ``[chart]`` of a case gives."""

from collections.abc import Mapping
from typing import Any

from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.studies.choices import combinations


def from_table(case: Case) -> dict[str, Mapping[str, Any]]:
    """The choices of the case's [chart] table by name; none without one."""
    table = case.chart
    found: dict[str, Mapping[str, Any]] = {**combinations(case, table.vary)} if table.vary else {}
    for choice in table.choice:
        if choice.name in found:
            raise CaseError([f"chart.choice: two choices have the name {choice.name}"], case.name)
        found[choice.name] = choice.set
    return found

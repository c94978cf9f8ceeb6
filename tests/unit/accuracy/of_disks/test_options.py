"""The choices that a case of disks leaves open."""

from collections.abc import Sequence
from typing import Any

import pytest
from small_cases import GRAINS, PUSHED, Tables, small

from dembound.accuracy.of_disks.options import Options
from dembound.running import plan


def steps(tables: Tables, kept: Sequence[str] = (), **changes: Any) -> set[float]:
    """The time steps of all choices with the given disks, over that of the case."""
    planned = plan(small(tables, changes=changes))
    return {round(option.case.run.safety / 0.9, 9) for option in Options(planned, 0.01, kept).of(1.0)}


@pytest.mark.parametrize(("kept", "expected"), [((), {1.0, 0.5, 0.25}), (("run.safety",), {1.0})])
def test_the_step_is_shorter_where_disks_remain(kept: Sequence[str], expected: set[float]) -> None:
    assert steps(GRAINS, kept, **{"run.safety": 0.9}) == expected


def test_the_step_follows_disks_that_may_change() -> None:
    assert steps(PUSHED, **{"run.safety": 0.9}) == {1.0}

"""Mean, spread and confidence, beside values of the literature."""

import numpy as np
import pytest

from dembound.studies.sweep.members import Member
from dembound.studies.sweep.perform import Outcome
from dembound.studies.sweep.tables import statistic, statistics


def test_the_interval_is_students() -> None:
    """The squared deviations of 2, 4, 4, 4, 5, 5, 7, 9 add to 32; t(0.975) of 7 degrees is 2.364624 (tables)."""
    found = statistic({}, "x", [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0])
    assert found.count == 8
    assert found.mean == 5.0
    assert found.spread == pytest.approx(np.sqrt(32.0 / 7.0), rel=1e-14)
    assert found.interval == pytest.approx(2.364624 * np.sqrt(32.0 / 7.0 / 8.0), rel=5e-7)  # of seven digits
    assert found.ends == (found.mean - found.interval, found.mean + found.interval)
    one = statistic({}, "x", [3.0])
    assert (one.mean, one.count) == (3.0, 1)
    assert np.isnan([one.spread, one.interval, *one.ends]).all()


def test_groups_are_averaged_without_members_that_failed(bar) -> None:
    changes = [{"packing.seed": seed, "run.safety": safety} for safety in (0.5, 0.9) for seed in (1, 2, 3)]
    members = [Member(str(number), each, bar(), str(number)) for number, each in enumerate(changes)]
    outcomes = [
        Outcome("0", values={"x": 1.0}),
        Outcome("1", failure="stalled", values={"x": 7.0}),
        Outcome("2", values={"x": 3.0, "y": 4.0}),
        Outcome("3", values={"x": 5.0}),
        None,
        Outcome("5", failure="killed"),
    ]
    found = [(each.group["run.safety"], each.quantity, each.count, each.mean) for each in statistics(members, outcomes)]
    assert found == [(0.5, "x", 2, 2.0), (0.5, "y", 1, 4.0), (0.9, "x", 1, 5.0)]

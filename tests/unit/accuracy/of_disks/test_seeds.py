"""Scatter between packings: the difference of one run from the mean of several, at the requested times."""

import numpy as np
import pytest
from small_cases import GRAINS, PUSHED, small

from dembound.accuracy import runner
from dembound.accuracy.of_disks.measured import cause_of_packing
from dembound.accuracy.runner import Run
from dembound.errors import CaseError
from dembound.formulas.history import History

TIME = np.linspace(0.0, 1.0, 21)


def test_runs_with_several_seeds_scatter_about_their_mean_and_lattices_have_none(monkeypatch):
    case = small(GRAINS, changes={"packing.seed": 7, "run.until": "silent"})
    seen = []

    def other(given, *_, **__):
        seen.append(given)
        motion = given.packing.seed * np.outer(TIME, [1.0, 2.0, 9.0])
        return Run(work=300, motions={"top": History.of(np.zeros(2), TIME, motion, 3.0 * motion)}), 0.0, 0.0

    monkeypatch.setattr(runner, "measure", other)
    times = np.array([0.0, 0.13, 0.7])
    motion = {"velocity": np.zeros((3, 2)), "displacement": np.zeros((3, 2))}
    (cause,) = cause_of_packing(case, {"top": History(np.zeros(2), times, motion)}, 3).found
    assert [each.packing.seed for each in seen] == [7, 8, 9]
    assert all(each.run.until != "silent" for each in seen)  # they must not end before the record
    # the first is one less than the mean of 7, 8 and 9; of three runs it is nearer to their own mean by √(2/3)
    np.testing.assert_allclose(cause.parts["top"]["displacement"], -np.outer(times, [1.0, 2.0]) * 1.5**0.5, atol=1e-12)
    np.testing.assert_allclose(
        cause.parts["top"]["velocity"], -3.0 * np.outer(times, [1.0, 2.0]) * 1.5**0.5, atol=1e-12
    )
    assert cause.is_sample
    assert cause.of_disks
    with pytest.raises(CaseError, match="no random packing"):
        cause_of_packing(small(PUSHED), {}, 2)

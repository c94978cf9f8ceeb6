"""What the seed of a packing adds: the difference to another run over √2, at the times of the record."""

import numpy as np
import pytest
from small_cases import GRAINS, PUSHED, small

from dembound.accuracy import runner
from dembound.accuracy.history import History
from dembound.accuracy.of_disks import seeds as packing
from dembound.accuracy.runner import Run
from dembound.errors import CaseError

TIME = np.linspace(0.0, 1.0, 21)


def test_the_difference_to_another_seed_over_the_root_of_two_and_none_of_a_lattice(monkeypatch):
    case = small(GRAINS, changes={"packing.seed": 7, "run.until": "silent"})
    seen = []

    def other(given, *_, **__):
        seen.append(given)
        motion = np.outer(TIME, [1.0, 2.0, 9.0])
        return Run(work=300, motions={"top": History.of(np.zeros(2), TIME, motion, 3.0 * motion)}), 0.0, 0.0

    monkeypatch.setattr(runner, "measure", other)
    times = np.array([0.0, 0.13, 0.7])
    own = {"velocity": np.outer(times, [5.0, 2.0]), "displacement": np.outer(times, [2.0, 5.0])}
    found = packing.cause_of_packing(case, {"top": History(np.zeros(2), times, own)}, 200.0)
    (cause,) = found.found
    np.testing.assert_allclose(cause.errors["top"]["velocity"], np.outer(times, [2.0, -4.0]) / 2**0.5, atol=1e-12)
    np.testing.assert_allclose(cause.errors["top"]["displacement"], np.outer(times, [1.0, 3.0]) / 2**0.5, atol=1e-12)
    assert found.cost == 1.5
    assert seen[0].packing.seed == 8
    assert seen[0].run.until != "silent"  # it must not end before the record
    with pytest.raises(CaseError, match="no random packing"):
        packing.cause_of_packing(small(PUSHED), {}, 1.0)

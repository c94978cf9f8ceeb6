"""Runs that end before their duration, once the monitors are silent."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.accuracy.proposal import END, LEAST_SAVED, Proposal, earlier_ends, ended_earlier
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import History

BAR: dict[str, Any] = PUSHED | {
    "packing": {"pattern": "A", "size": [30.0, 1.5], "radius": 0.25},
    "boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous"}},
    "motion": {"held": ["y", "rotation"]},
    "wave": {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.03}},
    "monitor": [{"name": "near", "position": [3.75, 0.75]}, {"name": "back", "position": [24.75, 0.75]}],
    "run": {"duration": 0.4},
}
"""A wave of 0.03 s that comes to the farther monitor after 0.0245 s, and has passed it at 0.0545 s."""

PASSED, ECHO = 0.0245 + 0.03, 2.0 * 26.25 / 1000.0
"""Time when the wave has passed, and travel time from the nearer monitor to the end on its right and back, s."""


def passing(late: float = 0.0) -> dict[str, History]:
    """The wave at both monitors, and a velocity of `late` m/s at the farther one from 0.3 s on."""
    wave, time = small(BAR).wave["push"], np.linspace(0.0, 0.4, 4001)
    found = {}
    for name, way, more in (("near", 3.5, 0.0), ("back", 24.5, late)):
        velocity = wave.velocity(time - way / 1000.0) + more * (time >= 0.3)
        displacement = np.cumsum(velocity) * 1e-4
        values = {"velocity": velocity, "displacement": displacement}
        found[name] = History(np.zeros(2), time, {q: np.column_stack([each, 0.0 * each]) for q, each in values.items()})
    return found


def test_a_run_ends_when_the_wave_has_passed_and_nothing_can_return() -> None:
    (end,) = earlier_ends(small(BAR), passing(), 0.01, [])
    assert end.case.run.until == "silent"
    assert end.case.run.duration == 0.4
    # the last that is above 1e-3 of a cosine's peak comes 0.02 of its length before its end
    assert end.share == pytest.approx((PASSED + ECHO) / 0.4, abs=0.002)
    assert all(not np.any(each) for values in end.lost.parts.values() for each in values.values())


def test_what_comes_later_is_an_error() -> None:
    """0.4 mm/s over the last 0.1 s: below 1e-3 of 0.5 m/s, so that the run would end before; 40 µm are lost."""
    motion = passing(4e-4)
    (end,) = earlier_ends(small(BAR), motion, 0.01, [])
    lost = end.lost.parts["back"]
    late = motion["back"].time >= 0.3
    np.testing.assert_array_equal(np.asarray(lost["velocity"])[:, 0], np.where(late, -4e-4, 0.0))
    assert np.asarray(lost["displacement"])[-1, 0] == pytest.approx(-4e-5, rel=1e-2)
    assert not np.any(lost["velocity"][:2500])
    assert earlier_ends(small(BAR), passing(6e-4), 0.01, []) == []  # now it is above 1e-3 of the peak until the end
    (end,) = earlier_ends(small(BAR), passing(2e-3), 0.3, [])  # a larger bound allows 0.1 · 0.3 of it
    assert end.case.run.silent_level == 0.03
    for kept in ("run", "run.duration", "run.until", "run.silent_level"):
        assert earlier_ends(small(BAR), passing(), 0.01, [kept]) == []
    enough = (PASSED + ECHO) / (1.0 - LEAST_SAVED)  # little is not worth while
    for duration, number in ((0.97 * enough, 0), (1.03 * enough, 1)):
        assert len(earlier_ends(small(BAR, changes={"run.duration": duration}), passing(), 0.01, [])) == number


def test_a_choice_keeps_its_bound_with_the_end() -> None:
    """40 µm are lost, 0.5 % of the final displacement of 7.5 mm, so that only larger bounds allow it."""
    case, motion = small(BAR), passing(4e-4)
    other = Cause("other", "", {name: {"velocity": 0.005, "displacement": 0.005} for name in motion}, factor=1.4)
    choice = Proposal(Choice("as it is", {}, case), 1.0, Budget(motion, Causes([other])))
    ended = ended_earlier(choice, case, 0.02, motion, [])
    assert ended.holds(0.02)
    assert ended.cost == pytest.approx((PASSED + ECHO) / 0.4, abs=0.01)
    assert ended.budget.worst().by[END] > 0.0
    assert "until the monitors are silent after about 0.1" in ended.choice.name
    assert ended_earlier(choice, case, 1.4 * 0.005 * (1.0 + 1e-6), motion, []) is choice


def test_sides_add_nothing_to_what_is_not_recorded() -> None:
    """Half of the late motion is reflected; a run that ends before it has only the error of the lost true motion."""
    case, true = small(BAR), passing(2e-4)
    sent = {
        name: {q: values - passing()[name].values[q] for q, values in own.values.items()} for name, own in true.items()
    }
    own = {
        name: replace(each, values={q: values + sent[name][q] for q, values in each.values.items()})
        for name, each in true.items()
    }
    (end,) = earlier_ends(case, own, 0.01, [])
    both = Budget(true, Causes([Cause("sides", "", sent), end.lost]))
    lost = true["back"].values["velocity"][true["back"].time >= 0.3]
    share = float(np.linalg.norm(lost) / np.linalg.norm(true["back"].values["velocity"]))
    assert both.total("back", "velocity").value == pytest.approx(share, rel=1e-9)

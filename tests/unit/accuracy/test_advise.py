"""The cheapest choice within an error, of a bar under a P wave."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from advised import advised
from small_cases import PUSHED, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.accuracy.estimate import advise
from dembound.accuracy.of_disks import candidates
from dembound.accuracy.proposal import END, LEAST_SAVED, Proposal, earlier_ends, ended_earlier
from dembound.accuracy.runner import measure
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import History, Motions
from dembound.running import Progress

BAR = PUSHED | {
    "packing": {"pattern": "A", "size": [30.0, 1.5], "radius": 0.25},
    "boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous", "beta_p": 0.6}},
    "motion": {"held": ["y", "rotation"]},
    "wave": {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.03}},
    "monitor": [{"name": "near", "position": [3.75, 0.75]}, {"name": "back", "position": [24.75, 0.75]}],
    "run": {"duration": 0.07},
}
"""Waves of 60 disks; factor 0.6 of the dashpots returns (1 - 0.6)/(1 + 0.6) = 25 % of the velocity."""

RETURNED = (1.0 - 0.6) / (1.0 + 0.6)


def exact(case: DiskCase, gauges: Motions, name: str) -> np.ndarray:
    """The velocity of a plane wave from the first disk of a case, at requested places."""
    way = {"near": 3.75, "back": 24.75}[name] - case.packing.radius
    return np.asarray(case.wave["push"].velocity(gauges[name].time - way / 1000.0))


def true_error(case: Any) -> float:
    """Largest RMS error of the velocity over the RMS velocity, without the delay of the wave's entry."""
    gauges = measure(case, Progress())[0].motions
    errors = [gauges[name].velocity[:, 0] - exact(case, gauges, name) for name in gauges]
    sizes = [exact(case, gauges, name) for name in gauges]
    return max(float(np.linalg.norm(e) / np.linalg.norm(s)) for e, s in zip(errors, sizes, strict=True))


def test_the_choice_is_as_accurate_as_asked_for_where_the_case_is_not() -> None:
    case = small(BAR)
    assert true_error(case) > 0.9 * RETURNED / 2**0.5  # the echo comes back to one monitor in full
    choice = advised(case, 0.02)
    assert choice.holds
    assert true_error(choice.case) < 0.02
    assert choice.cost <= choice.own_cost * 1.01  # matched dashpots need no more steps
    for name in ("material", "wave", "motion", "load", "hole", "run", "output"):
        assert getattr(choice.case, name) == getattr(case, name)
    assert choice.case.side("left") == case.side("left")
    assert [monitor.name for monitor in choice.case.monitor] == ["near", "back"]


def test_kept_keys_remain_and_the_best_is_returned_where_nothing_holds() -> None:
    case = small(BAR)
    choice = advised(case, 0.01, ["boundary", "packing"])
    assert not choice.holds
    assert choice.upper > 0.01
    assert choice.case.packing == case.packing
    assert choice.case.boundary == case.boundary
    assert choice.by["sides"] == pytest.approx(true_error(case), rel=0.1)


def test_what_whole_cells_at_a_side_reflect_is_counted() -> None:
    """An additional half cell at matched dashpots reflects about kD/4 of a wave, 2 % at 20 disks per wavelength."""
    sides = {"left": BAR["boundary"]["left"], "right": {"type": "viscous", "beta_p": 1.0}}
    case = small(BAR, changes={"boundary": sides, "wave.push.period": 0.012})

    choice = advised(case, 0.001, ["boundary", "packing"])

    assert choice.by["sides"] > 0.01
    assert choice.error == pytest.approx(true_error(case), rel=0.2)


def test_where_bonds_break_the_error_is_that_before() -> None:
    """A pulse of 1.25 MPa comes back from a free end as tension, and breaks bonds of 0.8 MPa."""
    tables = BAR | {
        "material": BAR["material"] | {"law": "linearpbond", "contact_share": 0.0, "pb_ten": 0.8e6},
        "boundary": {"left": {"type": "viscous_input", "wave_p": "push"}},
        "wave": {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.02}},
        "run": {"duration": 0.1},
    }
    choice = advised(small(tables), 0.1, ["boundary", "packing"])
    assert "the error is that before bonds break, after about 0.04" in choice.words
    assert choice.case.material.law == "linearpbond"
    assert choice.case.run.until == "duration"
    assert choice.holds


@pytest.mark.slow
def test_a_given_case_that_keeps_one_bound_in_less_time_than_a_search_is_taken() -> None:
    taken = advised(small(BAR), 0.6)
    assert taken.holds
    assert taken.choice.toml == []
    assert taken.tried == 1
    several = advise(small(BAR), (0.6, 0.5))  # larger disks cost less
    assert several.best[0.6].choice.changes
    assert several.best[0.6].cost < taken.cost
    of_these = advise(small(BAR), (0.6, 0.5), of="disks")  # of others the truth would be another one
    assert of_these.best[0.6].case.packing.radius == 0.25


def test_without_time_for_any_one_choice_is_tried_and_none_is_worse_than_the_given_case(monkeypatch) -> None:
    monkeypatch.setattr(candidates, "LONGEST", 0.0)
    choice = advised(small(BAR), 0.1)  # larger disks alone do not err so much
    assert (
        choice.words == "as in the case; the search ended early: it may take 12 s, or 20 % of the run or of --longest"
    )
    assert choice.cost == choice.own_cost
    assert choice.tried == 1


def test_what_cannot_be_chosen_for_is_refused() -> None:
    shake = {"name": "shake", "acceleration": [1.0, 0.0], "wave": "push"}
    steady = {"name": "foot", "force": [1.0, 0.0], "region": [5.0, 1.0, 6.0, 1.5]}
    shaken = BAR | {"boundary": {"right": {"type": "viscous"}}, "load": [shake, steady]}
    # to 24.5 m waves of 1,000 m/s take 24.5 ms; what runs ahead of them has faded after a few disks
    short = {"run": {"duration": 0.01}, "monitor": [{"name": "back", "position": [24.75, 0.75]}]}
    late = {"run": {"duration": 0.04}, "wave": {"push": BAR["wave"]["push"] | {"start": 0.05}}}
    for tables, bound, kept, said in (
        *((BAR, bound, [], "--error: is") for bound in (0.0, 1.0, -0.1, float("nan"))),
        (BAR, 0.01, ["packing.radios"], r"--keep: packing\.radios is no key"),
        ({key: value for key, value in BAR.items() if key != "monitor"}, 0.01, [], "needs a monitor"),
        (BAR | short, 0.01, [], "nothing moves at the monitors"),
        (BAR | late, 0.01, [], "nothing moves at the monitors"),
        (shaken, 0.01, [], r"load\.shake: starts waves everywhere"),
    ):
        with pytest.raises(CaseError, match=said):
            advise(small(tables), (bound,), kept=kept)


LONG_BAR = BAR | {"boundary": BAR["boundary"] | {"right": {"type": "viscous"}}, "run": {"duration": 0.4}}
"""A wave of 0.03 s that comes to the farther monitor after 0.0245 s, and has passed it at 0.0545 s."""

PASSED, ECHO = 0.0245 + 0.03, 2.0 * 26.25 / 1000.0
"""Time when the wave has passed, and travel time from the nearer monitor to the end on its right and back, s."""


def passing(late: float = 0.0) -> dict[str, History]:
    """The wave at both monitors, and a velocity of `late` m/s at the farther one from 0.3 s on."""
    wave, time = small(LONG_BAR).wave["push"], np.linspace(0.0, 0.4, 4001)
    found = {}
    for name, way, more in (("near", 3.5, 0.0), ("back", 24.5, late)):
        velocity = wave.velocity(time - way / 1000.0) + more * (time >= 0.3)
        displacement = np.cumsum(velocity) * 1e-4
        values = {"velocity": velocity, "displacement": displacement}
        found[name] = History(np.zeros(2), time, {q: np.column_stack([each, 0.0 * each]) for q, each in values.items()})
    return found


def test_a_run_ends_when_the_wave_has_passed_and_nothing_can_return() -> None:
    (end,) = earlier_ends(small(LONG_BAR), passing(), 0.01, [])
    assert end.case.run.until == "silent"
    assert end.case.run.duration == 0.4
    # the last that is above 1e-3 of a cosine's peak comes 0.02 of its length before its end
    assert end.share == pytest.approx((PASSED + ECHO) / 0.4, abs=0.002)
    assert all(not np.any(each) for values in end.lost.parts.values() for each in values.values())


def test_what_comes_later_is_an_error() -> None:
    """0.4 mm/s over the last 0.1 s: below 1e-3 of 0.5 m/s, so that the run would end before; 40 µm are lost."""
    motion = passing(4e-4)
    (end,) = earlier_ends(small(LONG_BAR), motion, 0.01, [])
    lost = end.lost.parts["back"]
    late = motion["back"].time >= 0.3
    np.testing.assert_array_equal(np.asarray(lost["velocity"])[:, 0], np.where(late, -4e-4, 0.0))
    assert np.asarray(lost["displacement"])[-1, 0] == pytest.approx(-4e-5, rel=1e-2)
    assert not np.any(lost["velocity"][:2500])
    assert (
        earlier_ends(small(LONG_BAR), passing(6e-4), 0.01, []) == []
    )  # now it is above 1e-3 of the peak until the end
    (end,) = earlier_ends(small(LONG_BAR), passing(2e-3), 0.3, [])  # a larger bound allows 0.1 · 0.3 of it
    assert end.case.run.silent_level == 0.03
    for kept in ("run", "run.duration", "run.until", "run.silent_level"):
        assert earlier_ends(small(LONG_BAR), passing(), 0.01, [kept]) == []
    enough = (PASSED + ECHO) / (1.0 - LEAST_SAVED)  # little is not worth while
    for duration, number in ((0.97 * enough, 0), (1.03 * enough, 1)):
        assert len(earlier_ends(small(LONG_BAR, changes={"run.duration": duration}), passing(), 0.01, [])) == number


def test_a_choice_keeps_its_bound_with_the_end() -> None:
    """40 µm are lost, 0.5 % of the final displacement of 7.5 mm, so that only larger bounds allow it."""
    case, motion = small(LONG_BAR), passing(4e-4)
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
    case, true = small(LONG_BAR), passing(2e-4)
    sent, own, early = {}, {}, passing()
    for name, each in true.items():
        sent[name] = {q: values - early[name].values[q] for q, values in each.values.items()}
        own[name] = replace(each, values={q: values + sent[name][q] for q, values in each.values.items()})
    (end,) = earlier_ends(case, own, 0.01, [])
    both = Budget(true, Causes([Cause("sides", "", sent), end.lost]))
    lost = true["back"].values["velocity"][true["back"].time >= 0.3]
    share = float(np.linalg.norm(lost) / np.linalg.norm(true["back"].values["velocity"]))
    assert both.total("back", "velocity").value == pytest.approx(share, rel=1e-9)

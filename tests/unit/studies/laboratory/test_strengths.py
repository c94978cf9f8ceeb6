"""The search for strengths of bonds, on samples whose strengths are known functions of those of their bonds."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from dembound.errors import CaseError
from dembound.studies.laboratory.strengths import CLOSE, COHESIONS, SHARES, Search, in_words
from dembound.studies.sweep.tables import Statistic

BOTH = {"ucs": 180e6, "tension": 50e6}
ONE_STRENGTH = np.divide(SHARES["ucs"][0], SHARES["tension"][0])
"""Ratios of the table."""

UCS, TENSION = (PchipInterpolator(np.log(COHESIONS), np.log(SHARES[test][0])) for test in ("ucs", "tension"))


class Rock:
    """Tension is a share of pb_ten to a power; the ratio of strengths is a function of pb_coh over pb_ten."""

    def __init__(self, share: float = 0.45, ratio: Callable[[float], float] | float = 1.0, power: float = 1.0) -> None:
        self.share, self.power, self.tested = share, power, []
        self.ratio = ratio if callable(ratio) else lambda c: ratio * float(np.exp(UCS(np.log(c)) - TENSION(np.log(c))))

    def measure(self, test, pb_ten, pb_coh) -> Statistic:
        self.tested.append((test, pb_ten, pb_coh))
        tension = self.share * 100e6 * (pb_ten / 100e6) ** self.power
        return Statistic({}, "strength", 8, tension * (self.ratio(pb_coh / pb_ten) if test == "ucs" else 1.0), 1e6, 1e6)


@pytest.mark.parametrize(("share", "ratio"), [(0.25, 0.93), (0.6, 1.05)])
def test_two_trials_give_both_strengths(share: float, ratio: float) -> None:
    rock = Rock(share, ratio)
    *_, last = trials = list(Search(BOTH).trials(rock.measure))

    assert [test for test, _, _ in rock.tested] == ["ucs", "tension"] * 2
    assert len(trials) == 2
    for test, target in BOTH.items():
        assert last.strengths[test].mean == pytest.approx(target, rel=2e-3)  # steps of `TRIED`, four digits
    assert "MPa ± 1 MPa (95 %) over 8 seeds, 0." in next(in_words(last, BOTH))


@pytest.mark.parametrize(("level", "slope"), [(3.8, 0.3), (2.95, 1.2)])  # of the table 3.4 and 0.7 there
def test_a_ratio_unlike_the_table_takes_a_third_trial(level: float, slope: float) -> None:
    rock = Rock(0.3, lambda cohesion: level * (cohesion / 0.9) ** slope)
    search = Search({"ucs": 180e6, "tension": 52e6})
    trials = list(search.trials(rock.measure))

    assert [trial.deviation(search.targets) > CLOSE for trial in trials] == [True, True, False]
    assert search.best(trials) is trials[-1]


def test_one_strength_scales_both_of_the_bonds() -> None:
    rock, targets = Rock(), {"tension": 10e6}
    *_, last = Search(targets, cohesion=0.8).trials(rock.measure)

    assert {test for test, _, _ in rock.tested} == {"tension"}
    assert last.strengths["tension"].mean == pytest.approx(10e6, rel=1e-3)
    assert last.cohesion == pytest.approx(0.8, rel=1e-3)


def test_bonds_without_moments_reach_the_ratio_of_rock() -> None:
    rock, targets = Rock(0.45, lambda cohesion: 3.4 * cohesion**0.75), {"ucs": 200e6, "tension": 12e6}
    with pytest.raises(CaseError, match=r"is 16\.7, .*pb_mcf = 0"):
        next(Search(targets).trials(rock.measure))
    search = Search(targets, moments=0.0)
    *_, last = search.trials(rock.measure)

    assert last.deviation(targets) <= CLOSE
    assert last.cohesion == pytest.approx((200.0 / 12.0 / 3.4) ** (1.0 / 0.75), rel=0.05)
    expected = [Search({}, 8.0, moments=moments).expected_ratio() for moments in (1.0, 0.5, 0.0)]
    assert expected[0] == pytest.approx(ONE_STRENGTH[-1])
    assert expected[2] == pytest.approx(8.8 / 0.492)
    assert expected[1] == pytest.approx(np.sqrt(expected[0] * expected[2]))

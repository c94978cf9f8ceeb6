"""The search for strengths of bonds, on samples whose strengths are known functions of those of their bonds."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.studies.laboratory.strengths import COHESIONS, RATIOS, changes_of, in_words, trials
from dembound.studies.sweep.statistics import Statistic


class Rock:
    """Tension is a share of pb_ten; the ratio of strengths is the tabulated one times a factor of the packing."""

    def __init__(self, share: float = 0.45, ratio: float = 1.0) -> None:
        self.share, self.ratio, self.tested = share, ratio, []

    def measure(self, test, pb_ten, pb_coh) -> Statistic:
        self.tested.append((test, pb_ten, pb_coh))
        tension = self.share * pb_ten
        times = self.ratio * float(np.interp(pb_coh / pb_ten, COHESIONS, RATIOS)) if test == "ucs" else 1.0
        return Statistic({}, "strength", 8, times * tension, 1e6, 1e6)


@pytest.mark.parametrize("ratio", [0.95, 1.0, 1.05])
def test_two_trials_give_both_strengths_from_above(ratio: float) -> None:
    rock, targets = Rock(ratio=ratio), {"ucs": 180e6, "tension": 48e6}
    first, second = trials(targets, 1.0, rock.measure, 5.0)

    assert [test for test, _, _ in rock.tested] == ["ucs", "tension"] * 2
    assert first.strengths["tension"].mean > targets["tension"]
    for test, target in targets.items():
        assert second.strengths[test].mean == pytest.approx(target, rel=0.02)
    pb_ten = changes_of(second, targets)["material.pb_ten"]
    assert pb_ten == pytest.approx(second.pb_ten, rel=0.02)
    assert "ucs 180 MPa ± 1 MPa (95 %) over 8 seeds" in next(in_words(second, targets))


def test_one_strength_scales_both_of_the_bonds() -> None:
    rock, targets = Rock(), {"tension": 10e6}
    _, second = trials(targets, 0.8, rock.measure, 5.0)

    assert second.strengths["tension"].mean == pytest.approx(10e6, rel=1e-3)
    assert second.pb_coh / second.pb_ten == pytest.approx(0.8, rel=1e-3)


def test_ratios_out_of_reach_are_refused() -> None:
    with pytest.raises(CaseError, match=r"is 10, parallel bonds of one strength reach about 5.*pb_scatter"):
        next(trials({"ucs": 100e6, "tension": 10e6}, 1.0, Rock().measure, 5.0))
    with pytest.raises(CaseError, match=r"must be 2\.04 or more"):
        next(trials({"ucs": 18e6, "tension": 10e6}, 1.0, Rock().measure, 5.0))
    weaker = Rock(ratio=0.8)  # 4.15 becomes 3.3
    with pytest.raises(CaseError, match=r"is 4, .*in this packing 3\.3"):
        list(trials({"ucs": 40e6, "tension": 10e6}, 1.0, weaker.measure, 5.0))

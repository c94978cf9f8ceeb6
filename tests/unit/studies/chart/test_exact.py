"""Which exact solutions cases have, and for how long they are valid."""

import math

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.studies.chart.exact import Continuum, PlaneWave, PulseInBar, exact_of
from dembound.studies.chart.measure import Gauge

EVEN = {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}


def test_a_bar_that_spalls_has_one_until_then(spalling) -> None:
    # s = 8/12, rise and fall 0.2 ms: d = ½·1000·0.2e-3·s from the free end, at rise + (L + d)/c
    found = exact_of(spalling())
    assert isinstance(found, PulseInBar)
    assert found.findings["spall place"] == pytest.approx(1.0 - 0.2 / 3.0)
    assert found.until == found.findings["spall time"] == pytest.approx(0.2e-3 + (1.0 + 0.2 / 3.0) / 1000.0)


def test_a_bar_that_holds_has_one_for_ever(spalling) -> None:
    assert exact_of(spalling({"bar.strength": 13e6})).until == math.inf


@pytest.mark.parametrize(
    "changes",
    [
        {"bar.attenuation": 0.1},
        {"load.1.side": "right"},
        {"load.1.pressure": -12e6},
        {"boundary.right": {"type": "viscous"}},
        {"boundary.left": {"type": "viscous"}},
        {"wave.hit": {"type": "cosine", "amplitude": 1.0, "period": 4e-4}},
        {"wave.hit.fall": 9e-4},
    ],
)
def test_other_bars_have_none(spalling, changes) -> None:
    with pytest.raises(CaseError, match="no exact solution"):
        exact_of(spalling(changes))


@pytest.mark.parametrize(("end", "echo"), [("free", 1.0), ("fixed", -1.0), ("viscous", 0.0)])
def test_the_far_end_of_a_bar_reflects(spalling, end: str, echo: float) -> None:
    case = spalling({"bar.strength": 1e9, "boundary.right": {"type": end}})
    time = np.array([0.7e-3, 1.7e-3])  # 0.5 m from the load: the crest of 0.2 ms, and its echo
    at = Gauge(np.array([0.5, 0.0]), time, np.zeros((2, 3)), np.zeros((2, 3)), np.zeros(2))
    crest = 12e6 / (2500.0 * 1000.0)
    found = exact_of(case).gauges(case, {"gauge": at})["gauge"]
    assert found.velocity[:, 0] == pytest.approx([crest, echo * crest])
    assert found.stress == pytest.approx([-12e6, echo * 12e6])


def test_a_plane_wave_that_leaves_has_one(bar) -> None:
    found = exact_of(bar(EVEN))
    assert isinstance(found, PlaneWave)
    assert (found.side, found.motion) == ("left", "p")


@pytest.mark.parametrize(
    "changes",
    [
        {"motion.held": []},
        {"boundary.right": {"type": "free"}},
        {"boundary.top": {"type": "fixed"}},
        {"hole": [{"name": "h", "type": "circle", "centre": [8.0, 0.5], "radius": 0.3}]},
        {"material.law": "linearpbond"},
        {"boundary.left": {"type": "viscous_input", "wave_s": "pulse"}, "motion.held": []},
    ],
)
def test_waves_that_do_not_stay_plane_or_do_not_leave_have_none(bar, changes) -> None:
    with pytest.raises(CaseError, match="no exact solution"):
        exact_of(bar({**EVEN, **changes}))


def test_s_waves_have_one_between_periodic_sides(bar) -> None:
    sides = {f"boundary.{side}": {"type": "periodic"} for side in ("bottom", "top")}
    wave = {"boundary.left": {"type": "viscous_input", "wave_s": "pulse"}, "motion.held": []}
    assert exact_of(bar({**wave, **sides})).motion == "s"


def test_lambs_problem_has_one() -> None:
    from dembound.kinds import load
    from dembound.shipped import folder

    case = load(folder() / "zhou2018" / "lamb_viscous.toml")
    found = exact_of(case)
    assert isinstance(found, Continuum)
    assert found.name == "lamb"

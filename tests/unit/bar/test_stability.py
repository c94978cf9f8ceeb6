"""The step of a bar, given in any way, beside the exact limit of its method."""

import pytest

from dembound.bar.banded import ROUNDING
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import choose_step
from dembound.errors import CaseError

CENTRAL = {"method": {"type": "finite_difference"}}
UNIT = 0.025 / 1000.0
"""Δx/c of the spalling bar, s; 1 is the largest Courant number of central differences with half masses at free ends."""


@pytest.mark.parametrize("cells", [10, 30, 41, 57, 99])
def test_a_bar_may_run_at_its_limit(spalling, cells: int) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "bar.spacing": 1.0 / cells})))

    assert step == pytest.approx(1e-3 / cells, rel=1e-15)
    assert limit == pytest.approx(step, rel=1e-12)


def test_a_limit_may_be_wrong_by_rounding_and_no_more(spalling, monkeypatch) -> None:
    scene = build_bar(spalling(CENTRAL))
    monkeypatch.setattr(BarScene, "step_limit", lambda scene: UNIT * (1.0 - 1e-12))
    assert choose_step(scene)[0] == pytest.approx(UNIT, rel=1e-15)

    monkeypatch.setattr(BarScene, "step_limit", lambda scene: UNIT * (1.0 - 1e-8))
    with pytest.raises(CaseError, match="must not be above 1, "):
        choose_step(scene)


@pytest.mark.parametrize("courant", [0.5, 1.0])
def test_a_bars_step_may_be_given_by_its_courant_number(spalling, courant: float) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "run.courant": courant})))

    assert step == pytest.approx(courant * UNIT, rel=1e-15)
    assert limit == pytest.approx(UNIT, rel=ROUNDING)


def refusal(spalling, run: dict, **changes: object) -> str:
    """The one line that a bar's step is refused with."""
    scene = build_bar(spalling({**CENTRAL, **changes, "run": {"duration": 1.5e-3, **run}}))
    with pytest.raises(CaseError) as caught:
        choose_step(scene)
    (problem,) = caught.value.problems
    return problem


def test_a_bars_step_above_its_limit_is_refused_in_the_words_of_the_case(spalling) -> None:
    assert refusal(spalling, {"courant": 1.001}) == "run.courant: is 1.001, must not be above 1, the stability limit"
    step = refusal(spalling, {"time_step": 1.001 * UNIT})
    assert step == "run.time_step: is 2.5025e-05 s, must not be above the stability limit 2.5e-05 s"


def test_a_step_must_serve_all_stages_of_a_bars_method(spalling) -> None:
    # with three spacings alone it could be nearly twice as long
    assert choose_step(build_bar(spalling({"run.courant": 1.9})))[0] == pytest.approx(1.9 * UNIT, rel=1e-15)
    for kind in ("switch", "patch"):
        problem = refusal(spalling, {"courant": 1.9}, method={"type": kind, "horizon": 3})
        assert problem.startswith("run.courant: is 1.9, must not be above 1, ")


def test_an_automatic_step_of_a_bar_is_the_share_of_its_limit(spalling) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "run": {"duration": 1e-3, "safety": 0.75}})))

    assert step == 0.75 * limit

"""The step of a bar, given in any way, beside the exact limit of its method."""

import pytest

from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step, shortened_in_words
from dembound.errors import CaseError

CENTRAL = {"method": {"type": "finite_difference"}}
UNIT = 0.025 / 1000.0
"""Δx/c of the spalling bar, s; 1 is the largest Courant number of central differences with half masses at free ends."""


@pytest.mark.parametrize("cells", [41])
def test_a_bar_may_run_at_its_limit(spalling, cells: int) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "bar.spacing": 1.0 / cells})))

    assert step == pytest.approx(1e-3 / cells, rel=1e-15)
    assert limit == pytest.approx(step, rel=1e-12)


PATCH = {"method": {"type": "patch", "horizon": 3}}


@pytest.mark.parametrize(
    ("run", "method", "problem"),
    [
        ({"courant": 1.001}, CENTRAL, "run.courant: is 1.001, must not be above 1, the stability limit"),
        ({"time_step": 1.001 * UNIT}, CENTRAL, "run.time_step: is 2.5025e-05 s, must not be above the stability limit"),
        # with three spacings alone it could be nearly twice as long; a step must serve all stages of the method
        ({"courant": 1.9}, PATCH, "run.courant: is 1.9, must not be above 1, "),
    ],
)
def test_a_bars_step_above_its_limit_is_refused_in_the_words_of_the_case(spalling, run, method, problem) -> None:
    scene = build_bar(spalling({**method, "run": {"duration": 1.5e-3, **run}}))
    with pytest.raises(CaseError) as caught:
        choose_step(scene)
    (said,) = caught.value.problems
    assert said.startswith(problem)


def test_a_step_is_that_of_its_courant_number_or_a_share_of_the_limit(spalling) -> None:
    assert choose_step(build_bar(spalling({"run.courant": 1.9})))[0] == pytest.approx(1.9 * UNIT, rel=1e-15)
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "run": {"duration": 1e-3, "safety": 0.75}})))
    assert step == 0.75 * limit


def blow(**wave: object) -> dict[str, object]:
    """A load on the left end node."""
    return {"load": [{"name": "blow", "pressure": 1e6, "wave": "it"}], "wave": {"it": {"amplitude": 1.0, **wave}}}


AT_ONCE = CENTRAL | blow(type="constant")
STEP = CENTRAL | blow(type="constant", start=0.5 * UNIT)
ODD = blow(type="triangle", rise=5.0 * UNIT, fall=10.0 * UNIT)
BOTH = blow(type="constant", start=0.5 * UNIT)
BOTH["load"] = [{"name": side, "side": side, "pressure": 1e6, "wave": "it"} for side in ("left", "right")]
SUDDENLY = (
    "run.courant: is 1, shortened to 0.99, 0.99 of the stability limit: at the limit so sudden loads leave swings"
)

ALIKE = [{"name": "a", "length": 0.5}, {"name": "b", "length": 0.5, "spacing": 0.0125, "wave_speed": 500.0}]
TOUCHING = [ALIKE[0], ALIKE[1] | {"interface": "contact"}]
UNLIKE = [ALIKE[0], ALIKE[1] | {"wave_speed": 500.1}]
PERIDYNAMIC = {"method": {"type": "peridynamics", "horizon": 3}}


@pytest.mark.parametrize(
    ("changes", "run", "line"),
    [
        (CENTRAL, {"courant": 1.0}, ""),
        (PATCH, {"safety": 1.0}, ""),
        (CENTRAL | {"bar.range": TOUCHING}, {"courant": 1.0}, "run.courant: is 1, shortened to 0.99, 0.99 of the stab"),
        (CENTRAL | {"bar.range": TOUCHING}, {"courant": 0.99}, ""),
        (CENTRAL | {"bar.range": UNLIKE}, {"courant": 1.0}, "run.courant: is 1, shortened to 0.990"),
        (PERIDYNAMIC, {"safety": 1.0}, "run.safety: is 1, shortened to 0.99"),
        (STEP, {"courant": 1.0}, SUDDENLY),
        # at a whole step a jump has its mean, which is d'Alembert's solution
        (AT_ONCE, {"courant": 1.0}, ""),
        # from its corners S = F/4 (1/5 + 1/5 + 1/10 − 1/10), by which springs swing by 0.2 F on the way of 40 cells
        (CENTRAL | ODD, {"courant": 1.0, "duration": 35 * UNIT}, ""),
        (CENTRAL | ODD, {"courant": 1.0, "duration": 70 * UNIT}, SUDDENLY),
        # equal pressures on both ends of an odd number of cells add up in the mode, of an even one they cancel
        (CENTRAL | {"bar.spacing": 1.0 / 39.0} | BOTH, {"courant": 1.0}, SUDDENLY),
        (CENTRAL | BOTH, {"courant": 1.0}, ""),
    ],
)
def test_only_waves_that_are_exact_may_have_a_step_at_the_limit(spalling, changes, run, line) -> None:
    scene = build_bar(spalling({**changes, "run": {"duration": 1.5e-3, **run}}))
    step, limit = choose_step(scene)
    said = shortened_in_words(scene, step)
    assert said.startswith(line)
    assert bool(said) == bool(line)
    assert (step == 0.99 * limit) == bool(line) or run == {"courant": 0.99}

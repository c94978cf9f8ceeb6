"""The stable step, against closed forms of the square lattice."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.bar.scene import BarScene, build_bar
from dembound.boundaries.support import SupportBuilder
from dembound.errors import CaseError
from dembound.scene import Scene, build
from dembound.stability import ROUNDING, TOLERANCE, choose_step, step_limit

MASS = 2500.0 * 0.5**2
K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact, N/m; with μ = 0 its shear stiffness is half of it."""

ONLY_X = {"motion.held": ["y", "rotation"]}


def free_chain(k: float, count: int) -> float:
    """Largest ω² of a chain with free ends: (4k/m) sin²((N − 1)π/2N)."""
    return 4.0 * k / MASS * np.sin((count - 1) * np.pi / (2 * count)) ** 2


def test_the_limit_of_a_lattice_that_moves_in_x_only(bar) -> None:
    scene = build(bar({**ONLY_X, "packing.size": [10.0, 2.0]}))
    # modes along x and y separate: normal springs along x, shear springs along y
    squared = free_chain(K, 20) + free_chain(0.5 * K, 4)

    assert step_limit(scene) == pytest.approx(2.0 / np.sqrt(squared), rel=TOLERANCE)


def test_the_limit_of_two_disks(bar) -> None:
    scene = build(bar({**ONLY_X, "packing.size": [1.0, 0.5], "monitor": []}))

    # ω² = 2k/m, from a dense solve
    assert step_limit(scene) == pytest.approx(2.0 / np.sqrt(2.0 * K / MASS), rel=1e-12)


def test_prescribed_motions_do_not_vibrate(bar) -> None:
    left = {"type": "velocity", "wave_p": "pulse"}
    scene = build(bar({**ONLY_X, "packing.size": [1.0, 0.5], "monitor": [], "boundary.left": left}))

    # one disk on one spring
    assert step_limit(scene) == pytest.approx(2.0 / np.sqrt(K / MASS), rel=1e-12)


def test_springs_of_supports_count(bar) -> None:
    scene = build(bar({**ONLY_X, "packing.size": [0.5, 0.5], "monitor": []}))
    supports = SupportBuilder()
    supports.add(np.array([0]), 0, stiffness=9.0 * MASS)

    # ω = 3
    assert step_limit(replace(scene, supports=supports.table())) == pytest.approx(2.0 / 3.0, rel=1e-12)


def test_dashpots_cost_no_stability(bar) -> None:
    strong = {"boundary.left.beta_p": 50.0, "boundary.right.beta_p": 50.0}

    assert step_limit(build(bar(strong))) == step_limit(build(bar()))


def test_the_same_scene_has_the_same_limit(bar) -> None:
    assert step_limit(build(bar())) == step_limit(build(bar()))


def given(bar, step: float | str, **more: object) -> Scene:
    return build(bar({"run.time_step": step, **more}))


def test_an_automatic_step_is_the_share_of_the_limit_asked_for(bar) -> None:
    step, limit = choose_step(build(bar({"run.safety": 0.75})))

    # cut to four digits
    assert 0.0 <= 1.0 - step / (0.75 * limit) < 1e-3
    assert float(f"{step:.4g}") == pytest.approx(step, rel=1e-15)


def test_a_given_step_is_taken_as_it_is(bar) -> None:
    step, limit = choose_step(given(bar, 1e-4))

    assert step == 1e-4
    assert limit > step


def test_a_step_above_the_limit_is_refused_and_told_the_limit(bar) -> None:
    limit = step_limit(build(bar()))
    with pytest.raises(CaseError) as caught:
        choose_step(given(bar, 1.01 * limit))

    (problem,) = caught.value.problems
    assert problem.startswith("run.time_step: ")
    assert f"{limit:.6g}" in problem


def test_a_scene_in_which_nothing_vibrates_needs_a_step_of_its_own(bar) -> None:
    still = {"boundary.left": {"type": "fixed"}, "packing.size": [0.5, 0.5], "monitor": []}
    with pytest.raises(CaseError, match=r"run\.time_step: .*give a step in s"):
        choose_step(given(bar, "auto", **still))

    assert choose_step(given(bar, 1e-3, **still)) == (1e-3, np.inf)


def test_the_limit_is_never_too_large(bar) -> None:
    # a lattice's largest frequencies lie close, so Lanczos iteration ends early; sides as above
    for width, height in ((20.0, 1.0), (50.0, 5.0), (20.0, 20.0)):
        scene = build(bar({**ONLY_X, "packing.size": [width, height], "monitor": []}))
        squared = free_chain(K, round(2 * width)) + free_chain(0.5 * K, round(2 * height))
        assert step_limit(scene) <= 2.0 / np.sqrt(squared)


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
    given = refusal(spalling, {"time_step": 1.001 * UNIT})
    assert given == "run.time_step: is 2.5025e-05 s, must not be above the stability limit 2.5e-05 s"


def test_a_step_must_serve_all_stages_of_a_bars_method(spalling) -> None:
    # with three spacings alone it could be nearly twice as long
    assert choose_step(build_bar(spalling({"run.courant": 1.9})))[0] == pytest.approx(1.9 * UNIT, rel=1e-15)
    for kind in ("switch", "patch"):
        problem = refusal(spalling, {"courant": 1.9}, method={"type": kind, "horizon": 3})
        assert problem.startswith("run.courant: is 1.9, must not be above 1, ")


def test_an_automatic_step_of_a_bar_is_the_share_of_its_limit(spalling) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "run": {"duration": 1e-3, "safety": 0.75}})))

    assert step == 0.75 * limit

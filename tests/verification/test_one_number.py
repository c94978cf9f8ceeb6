"""The error of a case is the same by `check`, `estimate` of its run, `advise`, and a chart of it.

Estimates and advice both take companions, so that causes agree to rounding where there are any. Where an estimate has
only the record, formulas see the motion of the disks themselves in place of that of larger ones, which differ by their
dispersion, some per cent of a share; of bars a record ends up to a step before the motion that advice computes. A chart
measures the sides beside an extended scene: companions of three times larger disks meet that within a factor 1.3
(test_estimated_errors.py). What an error is at most is at most 3 times what is expected.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from estimated_bars import scene as bar_scene
from small_cases import Tables, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.chart.study import Options, chart
from dembound.accuracy.estimate import advise, causes_of
from dembound.accuracy.judge import extended, judge_of
from dembound.accuracy.runner import measure
from dembound.casefile import Case
from dembound.formulas.cause import CONTINUUM, SIDES
from dembound.formulas.history import History
from dembound.running import Progress, plan

ROCK: Tables = {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5, "kratio": 0.5, "pb_kratio": 0.5}
FORCE: Tables = {
    "packing": {"pattern": "A", "size": [30.0, 20.0], "radius": 0.5},
    "material": ROCK,
    "boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom")},
    "wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 15.0}},
    "load": [{"name": "hit", "force": [0.0, -1e6], "region": [13.0, 19.0, 17.0, 20.0], "wave": "pulse"}],
    "monitor": [{"name": "surface", "position": [21.5, 19.5]}, {"name": "deep", "position": [18.5, 12.5]}],
    "run": {"duration": 0.15},
    "output": {"pictures": False},
}
SHEARED: Tables = FORCE | {
    "packing": {"pattern": "A", "size": [8.0, 20.0], "radius": 0.5},
    "boundary": {
        "left": {"type": "free_field"},
        "right": {"type": "free_field"},
        "bottom": {"type": "viscous_input", "wave_s": "pulse", "beta_s": 0.9},
    },
    "load": [],
    "hole": [{"name": "drift", "type": "rectangle", "corners": [2.0, 8.0, 5.0, 11.0]}],
    "monitor": [{"name": "surface", "position": [3.5, 19.5]}],
}
SCENES: dict[str, Tables] = {
    "force": FORCE,
    "springs": FORCE
    | {"boundary": {key: {"type": "viscoelastic", "source": [15.0, 20.0]} for key in ("left", "right", "bottom")}},
    "continuum": FORCE | {"boundary": {key: {"type": "outside"} for key in ("left", "right", "bottom")}},
    "hole": SHEARED,
    "random": FORCE
    | {"packing": {"pattern": "B", "size": [30.0, 20.0], "radius": 0.5, "radius_ratio": 1.5, "brick": [10.0, 10.0]}},
    "strong": FORCE | {"material": ROCK | {"law": "linearpbond", "pb_ten": 1e9, "pb_coh": 1e9}},
}


@contextmanager
def quiet(name: str) -> Iterator[Progress]:
    yield Progress()


def of_run(case: Case) -> Budget:
    """The estimate of a run."""
    run = measure(case, Progress())[0]
    recorded = {
        name: History(own.place, own.time, {q: values[:, :2] for q, values in own.values.items()})
        for name, own in run.motions.items()
    }
    causes = causes_of(case, recorded, run.time_step, run.work)
    return Budget(causes.motions or recorded, causes, judge_of(case).truth(case))


def cases() -> list[Any]:
    """Cases of disks and of bars, with how far their numbers may differ."""
    disks = [
        pytest.param(
            small(tables),
            0.06 if name == "continuum" else 1e-9,
            id=name,
            marks=[pytest.mark.slow] if name in ("springs", "strong", "random", "hole") else [],
        )
        for name, tables in SCENES.items()
    ]
    names = ("m = 3, soft ends", "viscous end, β = 0.7", "ranges", "ricker", "attenuation", "matched layer, m = 3")
    few = ("viscous end, β = 0.7", "ricker")
    bars = [
        pytest.param(bar_scene(name), 0.02, id=name, marks=[] if name in few else [pytest.mark.slow]) for name in names
    ]
    return [*disks, *bars]


@pytest.mark.parametrize(("case", "apart"), cases())
def test_all_commands_agree(case: Case, apart: float) -> None:
    own, advised = of_run(case), advise(case, ()).given.budget
    quick = {cause.name: cause for cause in judge_of(case).quick(plan(case).scene).found if cause.how != "unknown"}

    for name in advised.motions:
        for quantity in advised.quantities(name):
            shares, others = own.shares(name, quantity, "rock"), advised.shares(name, quantity, "rock")
            for cause in shares.keys() & others.keys():
                assert shares[cause] == pytest.approx(others[cause], rel=apart, abs=1e-4), (name, quantity, cause)
                if cause in quick:
                    assert quick[cause].share(name, quantity, advised.motions[name]) == others[cause]
            for of in ("disks", "rock"):
                total = own.total(name, quantity, of)  # type: ignore[arg-type]
                assert total.value <= total.upper <= (3.0 + 1e-9) * total.value
    assert own.of == advised.of


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name == "hole" else [pytest.mark.slow])
        for name in ("force", "hole", "continuum", "springs", "random")
    ],
)
def test_a_chart_gives_the_same_numbers(name: str, tmp_path: Any) -> None:
    """Errors that its reference leaves out are those known by formula, and errors that it measures are those of sides.

    A total is one number there, which is to be within what others expect at least, value²/upper, and at most.
    """
    case = small(SCENES[name])
    charted = chart(case, Options({"as it is": {}}, 1, "extended"), tmp_path / "chart", False, quiet)
    (line,), reference, found = charted.lines, charted.reference, advise(case, ()).given.budget
    assert reference.of == found.of
    assert {each.monitor for each in line.errors} == set(found.motions)
    motions = reference.motions(line.choice, line.outcome)
    causes = judge_of(case).of_reference(extended(case).case, motions, line.outcome.time_step)
    added = Budget(causes.motions or motions, causes, reference.of)
    for each in line.errors:
        others, own = (budget.shares(each.monitor, "velocity", "rock") for budget in (found, added))
        # the continuum round the enlarged scene is farther away, and the monitors are where they are
        for cause in own.keys() & others.keys() - {CONTINUUM}:
            assert own[cause] == pytest.approx(others[cause], rel=0.06, abs=1e-4), (each.monitor, cause)
        assert own.keys() <= others.keys() | {CONTINUUM}
        if SIDES in others:
            assert 1.0 / 1.3 < others[SIDES] / each.rms < 1.3
        total = found.total(each.monitor, "velocity")
        assert total.value**2 / total.upper < each.total < total.upper

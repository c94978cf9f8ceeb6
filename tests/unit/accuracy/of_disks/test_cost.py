"""Costs and time steps that are counted from the tables of a case, beside those of its plan."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from small_cases import small

from dembound.accuracy.of_disks.cost import MOST, Along, Counted, planned_cost
from dembound.accuracy.of_disks.options import Options
from dembound.running import plan

ROCK = {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5}
VISCOUS = {"type": "viscous"}
RICKER = {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 25.0}}
PUSH = {"name": "push", "force": [0.0, -1e6], "region": [14.0, 14.0, 16.0, 15.0], "wave": "pulse"}

FORCE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [30.0, 15.0], "radius": 0.5},
    "material": ROCK,
    "boundary": dict.fromkeys(("left", "right", "bottom"), VISCOUS),
    "wave": RICKER,
    "load": [PUSH],
    "monitor": [{"name": "beside", "position": [20.5, 14.5]}],
    "run": {"duration": 0.1},
}
WITHOUT = {key: value for key, value in FORCE.items() if key != "load"}
TUNNEL = WITHOUT | {
    "packing": {"pattern": "A", "size": [40.0, 30.0], "radius": 0.5},
    "boundary": {
        "left": {"type": "free_field"},
        "right": {"type": "free_field"},
        "bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True},
    },
    "hole": [{"name": "tunnel", "type": "circle", "centre": [20.0, 15.0], "radius": 4.0}],
    "monitor": [{"name": "wall", "position": [26.5, 15.5]}],
}
BAR = WITHOUT | {
    "packing": {"pattern": "A", "size": [60.0, 3.0], "radius": 0.5},
    "motion": {"held": ["y", "rotation"]},
    "boundary": {"left": {"type": "velocity", "wave_p": "pulse"}, "right": VISCOUS},
    "monitor": [{"name": "far", "position": [50.5, 1.5]}],
}
RANDOM = FORCE | {
    "packing": {
        "pattern": "B",
        "radius": 0.5,
        "radius_ratio": 1.5,
        "brick": [10.0, 15.0],
        "seed": 1,
        "size": [30.0, 15.0],
    },
}
FOUR = FORCE | {
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom", "top")},
    "load": [PUSH | {"region": [14.0, 7.0, 16.0, 8.0]}],
}

BOUNDS = (0.85, 1.1)
"""Counted cost over planned cost: 0.90 to 1.05 of 203 choices of ten larger scenes. Where bricks meet the nodes of
elements at more places than in the piece that the step is found on, this may be shorter by 8 %."""


def options_of(tables: dict[str, Any], **changes: Any) -> Options:
    case = small(tables, changes=changes) if changes else small(tables)
    return Options(plan(case), 0.02, ())


@pytest.mark.parametrize(
    ("tables", "factors"),
    [
        pytest.param(FORCE, (1.5, 1.0), id="force"),
        pytest.param(TUNNEL, (2.0, 1.0), id="tunnel", marks=pytest.mark.slow),
        pytest.param(RANDOM, (1.0,), id="random", marks=pytest.mark.slow),
        pytest.param(FOUR, (2.0, 1.0), id="outside"),
    ],
)
def test_counted_costs_are_those_of_plans(tables: dict[str, Any], factors: tuple[float, ...]) -> None:
    options = options_of(tables)
    names = set()
    for factor in factors:
        for option in options.of(factor):
            if option.wider:
                continue
            built = options.build(option)
            if built is None:
                continue
            names.add(option.arrangement)
            assert BOUNDS[0] <= option.cost / built.cost <= BOUNDS[1], option.words
            counted, planned = Counted(options.given).of(option.case), planned_cost(built.planned)
            assert counted.disks == pytest.approx(planned.disks, rel=0.02), option.words
            assert counted.nodes == pytest.approx(planned.nodes, rel=0.02), option.words
    assert len(names) > 1 or tables is FOUR


def test_choices_keep_what_is_to_be_kept() -> None:
    case = small(BAR)
    given = plan(case)
    assert {each.factor for each in Options(given, 0.02, ["packing.radius"]).of(1.0)} == {1.0}
    assert Options(given, 0.02, ["packing.radius"]).factors == [1.0]
    kept = Options(given, 0.02, ["boundary"]).of(1.0)
    assert {each.arrangement for each in kept} == {"sides as given", "viscous sides"}  # as they are
    assert not any(each.wider for each in Options(given, 0.02, ["packing.size"]).of(1.0))


@pytest.mark.parametrize(("bricks", "elements", "brick"), [(60, 9, 1.0), (56, 11, 1.0), (4, 4, 25.0)])
def test_a_piece_has_bricks_where_the_case_has_them(bricks: int, elements: int, brick: float) -> None:
    piece = Along(bricks, elements).shorter(brick)
    ratio = Fraction(bricks, elements)
    assert piece.elements <= MOST
    if ratio.denominator <= MOST and ratio * Fraction(brick) <= 12:
        assert Fraction(*piece) == ratio
    elif ratio * Fraction(brick) <= 12:
        assert Fraction(*piece).denominator >= MOST - 1  # nowhere do all bricks meet nodes alike
        assert float(Fraction(*piece)) == pytest.approx(float(ratio), rel=0.1)

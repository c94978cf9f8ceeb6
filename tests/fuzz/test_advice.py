"""Advice for random cases of disks: the choice is built, has all monitors, and runs with the predicted error.

Forces at the surface or inside, or a wave from below, with a hole or without, beside dashpots, springs, columns or a
continuum, on lattices and a random packing. Each choice is written as text and read again, and has the monitors, loads
and holes of the case at their places. The error relative to a run of the chosen disks with far sides is at most three
times the bound.
"""

import random
from typing import Any

import numpy as np
import pytest
from small_cases import small

from dembound.accuracy.estimate import advise
from dembound.accuracy.judge import extended
from dembound.accuracy.runner import measure
from dembound.casefile.disks import DiskCase
from dembound.casefile.edit import edited
from dembound.errors import DemboundError
from dembound.formulas.history import loud
from dembound.kinds import loads, with_changes
from dembound.running import Progress, plan

BOUND = 0.1


def some_case(seed: int) -> DiskCase:
    """A random case of at most some thousand disks."""
    draw = random.Random(seed)
    wide, high = draw.choice([20.0, 30.0, 36.0]), draw.choice([16.0, 24.0])
    side = draw.choice(
        [{"type": "viscous"}, {"type": "viscoelastic", "source": [0.5 * wide, high]}, {"type": "outside"}]
    )
    from_below = draw.random() < 0.4
    wave = draw.choice([{"type": "ricker", "frequency": 15.0}, {"type": "cosine", "period": 0.06}])
    x, y = round(draw.uniform(0.3, 0.7) * wide, 2), round(draw.uniform(0.5, 0.95) * high, 2)
    packing = {"pattern": "A", "size": [wide, high], "radius": 0.5}
    if draw.random() >= 0.8:
        packing |= {"pattern": "B", "size": [30.0, 24.0], "radius_ratio": 1.5, "brick": [10.0, 8.0]}
    tables: dict[str, Any] = {
        "packing": packing,
        "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5, "kratio": 0.5, "pb_kratio": 0.5},
        "boundary": {"left": side, "right": side, "bottom": side},
        "wave": {"pulse": wave | {"amplitude": 1.0}},
        "load": [{"name": "hit", "force": [draw.uniform(-1e6, 1e6), -1e6], "position": [x, y], "wave": "pulse"}],
        "monitor": [
            {"name": name, "position": [round(draw.uniform(2.0, wide - 2.0), 2), round(draw.uniform(2.0, high), 2)]}
            for name in ("a", "b")
        ],
        "run": {"duration": 0.12},
        "output": {"pictures": False},
    }
    if from_below:
        tables["load"] = []
        is_outside = side["type"] == "outside"
        beside, below = (side if is_outside else {"type": name} for name in ("free_field", "viscous_input"))
        tables["boundary"] = {"left": beside, "right": beside, "bottom": below | {"wave_s": "pulse"}}
    if draw.random() < 0.5 and packing["pattern"] == "A" and not (2.0 < abs(x - 0.5 * wide) < 6.0):
        tables["hole"] = [{"name": "drift", "type": "circle", "centre": [4.0, 5.0], "radius": 2.0}]
    made = small(tables)
    assert isinstance(made, DiskCase)
    return made


@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 101))])
def test_what_is_advised_runs_and_is_as_accurate_as_expected(seed: int) -> None:
    try:
        case = some_case(seed)
        plan(case)
        advice = advise(case, (BOUND, 0.5 * BOUND))
    except DemboundError as error:
        pytest.skip(str(error))
    for bound, proposal in advice.best.items():
        written = loads(edited(case.text, proposal.choice.changes), case.folder, "advised")
        assert isinstance(written, DiskCase)
        plan(written)
        for table in ("monitor", "load", "hole"):
            assert getattr(written, table) == getattr(case, table) or written.ground.size is None
        if proposal.holds(bound):
            assert error_of(written) <= 3.0 * bound


def error_of(case: DiskCase) -> float:
    """The error of a run beside one of the same disks from whose sides nothing returns; 0 where there is none."""
    own = measure(case, Progress())[0].motions
    try:
        if case.ground.size is not None:
            finer = {"outside.accuracy": 1e-3, "outside.margin": 8}
            far = measure(with_changes(case, finer), Progress())[0].motions
        else:
            far = measure(extended(case).case, Progress())[0].motions
    except DemboundError:
        return 0.0
    found = []
    for quantity in ("velocity", "displacement"):
        for name in loud(far, quantity):
            there = far[name].at(own[name].time).values[quantity][:, :2]
            column = int(np.argmax(np.abs(there).max(axis=0)))
            rest = own[name].values[quantity][:, column] - there[:, column]
            found.append(float(np.linalg.norm(rest) / np.linalg.norm(there[:, column])))
    return max(found)

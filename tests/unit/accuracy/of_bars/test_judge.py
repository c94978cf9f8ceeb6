"""The finer reference of bars: its nodes, its case, and its places."""

import numpy as np
import pytest

from dembound.accuracy.choice import Choice
from dembound.accuracy.of_bars.judge import finer
from dembound.accuracy.runner import Run
from dembound.formulas.history import History
from dembound.kinds import with_changes


def outcome(*positions: float) -> Run:
    """An outcome with gauges at these places, m."""
    nothing = np.zeros((1, 3))
    gauges = {f"g{k}": History.of(np.array([x, 0.0]), np.zeros(1), nothing, nothing) for k, x in enumerate(positions)}
    return Run(motions=gauges)


def choices(case, *spacings: float) -> list[Choice]:
    return [Choice(f"{size}", {}, with_changes(case, {"bar.spacing": size})) for size in spacings]


@pytest.mark.parametrize(
    ("spacings", "cells"),
    [
        ((0.05,), 80),
        ((0.05, 0.025), 160),
        ((0.1, 1.0 / 12.0), 60),  # 10 and 12 cells
        ((1.0 / 39.0, 0.025), 160),  # 39 · 40 would be 39 times as many as the finest
    ],
)
def test_its_nodes_are_where_those_of_all_choices_are(spalling, spacings, cells: int) -> None:
    case = spalling()
    found = finer(case, choices(case, *spacings), [outcome(0.5)])
    assert found.case.bar.cells == found.cells == cells
    assert found.spacing == pytest.approx(1.0 / cells)


def test_it_is_the_same_bar_by_finite_differences_at_courant_one(spalling) -> None:
    case = spalling(
        {
            "run": {"duration": 1e-3, "safety": 0.5, "until": "silent", "silent_level": 0.01},
            "method": {"type": "peridynamics", "horizon": 3},
            "load.1.nodes": 3,
        }
    )
    found = finer(case, choices(case, 0.025), [outcome(0.5)]).case
    assert found.run.model_dump(exclude_unset=True) == {"duration": 1e-3, "courant": 1.0}
    assert found.method.type == "finite_difference"
    assert found.load[0].nodes == 1  # on the end, at any spacing
    assert (found.load[0].pressure, found.wave, found.boundary) == (case.load[0].pressure, case.wave, case.boundary)


def test_it_records_at_the_places_of_every_choice(spalling) -> None:
    case = spalling()
    of_choices = [outcome(0.35, 1.0), outcome(0.325, 1.0)]
    found = finer(case, choices(case, 0.05, 0.025), of_choices)
    assert [monitor.position for monitor in found.case.monitor] == pytest.approx([0.325, 0.35, 1.0])
    run = Run(motions={m.name: outcome(m.position).motions["g0"] for m in found.case.monitor})
    for choice in of_choices:
        places = {name: gauge.place[0] for name, gauge in found.motions(run, choice).items()}
        assert places == pytest.approx({name: gauge.place[0] for name, gauge in choice.motions.items()})

"""The ledger is drawn column by column, its error apart."""

import h5py
import numpy as np
import pytest

from dembound.plot.energy import COLUMNS, NEGLIGIBLE, OF_STEPS, plot_energy
from dembound.results.datasets import datasets_of

SIDES = {"bottom": (5.0, 2.0, 0.0), "left": (0.0, 3.0, 0.25), "bottom.free_field": (-0.5, 1.5, 0.0)}


def ledger_of(run):
    with h5py.File(run) as file:
        return {name: values[:] for name, values in datasets_of(file["energy"]).items() if "/" not in name}


def fill(file, values=1.0):
    """Set all columns of the ledger to this value, J/m."""
    for name in COLUMNS:
        file["energy"][name][:] = values


@pytest.fixture
def divided(cracked_run, run, copied):
    """A record with two sides and the column of one, and all columns of the ledger 1 J/m."""
    with copied(cracked_run) as file:
        file["energy"].pop("sides", None)
        fill(file)
        count = len(file["energy/time"])
        for side, values in SIDES.items():
            for name, value in zip(("came_in", "absorbed", "stored"), values, strict=True):
                file[f"energy/sides/{side}/{name}"] = np.full(count, value)
    return run


def test_every_column_that_is_not_zero_is_a_line(cracked_run):
    figure = plot_energy(cracked_run)
    upper, lower = figure.axes
    drawn = {line.get_label(): line for line in upper.lines}
    ledger = ledger_of(cracked_run)
    largest = {name: np.abs(ledger[name]).max() for name in COLUMNS}
    unit = 1e3 if upper.get_ylabel() == "energy per metre of thickness (kJ/m)" else 1.0
    for name, label in COLUMNS.items():
        least = OF_STEPS if name == "stepping" else NEGLIGIBLE
        if name != "loads" and largest[name] > least * max(largest.values()):  # of one side: all is outside
            np.testing.assert_allclose(
                drawn.pop(label).get_data(), [ledger["time"] / 1e-3, ledger[name] / unit], rtol=1e-14
            )
    assert drawn == {}
    (error,) = lower.lines
    np.testing.assert_array_equal(error.get_ydata(), ledger["error"] / ledger["supplied"][-1])


def test_what_came_in_and_what_was_absorbed_is_drawn_for_every_side(divided):
    drawn = {line.get_label(): line for line in plot_energy(divided).axes[0].lines}
    assert COLUMNS["outside"] not in drawn  # else the same energy was there twice
    assert drawn[COLUMNS["loads"]].get_ydata()[-1] == 1.0
    of_sides = {label: line.get_ydata()[-1] for label, line in drawn.items() if label not in COLUMNS.values()}
    assert of_sides == {
        "supplied: through the bottom side": 5.0,
        "supplied: through the bottom side of the column": -0.5,
        "absorbed: by the bottom side": 2.0,
        "absorbed: by the left side": 3.0,
        "absorbed: by the bottom side of the column": 1.5,
        "stored: springs of the left side": 0.25,
    }

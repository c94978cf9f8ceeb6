"""The ledger is drawn column by column, its error apart."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.energy import COLUMNS, NEGLIGIBLE, OF_STEPS, plot_energy
from dembound.plot.table import columns_of
from dembound.results.datasets import datasets_of


def ledger_of(run):
    with h5py.File(run) as file:
        return {name: values[:] for name, values in datasets_of(file["energy"]).items() if "/" not in name}


def test_every_column_that_is_not_zero_is_a_line(cracked_run):
    upper, lower = plot_energy(cracked_run).axes
    drawn = {line.get_label(): line for line in upper.lines}
    ledger = ledger_of(cracked_run)
    assert ledger.keys() == {"time", "supplied", "error", *COLUMNS}
    largest = {name: np.abs(ledger[name]).max() for name in COLUMNS}
    unit = 1e3 if upper.get_ylabel() == "energy per metre of thickness (kJ/m)" else 1.0
    for name, label in COLUMNS.items():
        least = OF_STEPS if name == "stepping" else NEGLIGIBLE
        if name != "loads" and largest[name] > least * max(largest.values()):  # of one side: all is outside
            np.testing.assert_allclose(
                drawn.pop(label).get_data(), [ledger["time"] / 1e-3, ledger[name] / unit], rtol=1e-14
            )
    assert drawn == {}
    assert np.any(ledger["kinetic"])
    assert not np.any(ledger["damping"])
    (error,) = lower.lines
    np.testing.assert_array_equal(error.get_ydata(), ledger["error"] / ledger["supplied"][-1])


@pytest.fixture
def divided(cracked_run, tmp_path):
    """A record with two sides and the column of one, and all columns of the ledger 1 J/m."""
    run = tmp_path / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["energy"].pop("sides", None)
        for name in COLUMNS:
            file["energy"][name][:] = 1.0
        count = len(file["energy/time"])
        for side, values in SIDES.items():
            for name, value in zip(("came_in", "absorbed", "stored"), values, strict=True):
                file[f"energy/sides/{side}/{name}"] = np.full(count, value)
    return run


@pytest.fixture
def surrounded(divided):
    """The same with all sides that a box in the ground, its continuum and its column have."""
    with h5py.File(divided, "r+") as file:
        own = file["energy/sides/bottom"]
        for side in ALL_SIDES:
            if side not in SIDES:
                file.copy(own, f"energy/sides/{side}")
    return divided


def test_each_of_many_sides_has_its_own_colour_and_name(surrounded):
    lines = plot_energy(surrounded).axes[0].lines
    came_in = [line for line in lines if line.get_label().startswith("in: through the ")]
    assert len(came_in) == len({line.get_label() for line in lines if line in came_in}) == len(ALL_SIDES) - 1
    assert len({line.get_color() for line in came_in}) == len(came_in)


PLACES = ("left", "right", "bottom", "top")
ALL_SIDES = (*PLACES, *(f"{side}.continuum" for side in PLACES), "bottom.free_field", "bottom.free_field.continuum")

SIDES = {"bottom": (5.0, 2.0, 0.0), "left": (0.0, 3.0, 0.25), "bottom.free_field": (-0.5, 1.5, 0.0)}


def test_what_came_in_and_what_was_absorbed_is_drawn_for_every_side(divided):
    drawn = {line.get_label(): line for line in plot_energy(divided).axes[0].lines}
    assert COLUMNS["outside"] not in drawn  # else the same energy was there twice
    assert drawn[COLUMNS["loads"]].get_ydata()[-1] == 1.0
    of_sides = {label: line.get_ydata()[-1] for label, line in drawn.items() if label not in COLUMNS.values()}
    assert of_sides == {
        "in: through the bottom side": 5.0,
        "in: through the bottom side of the column": -0.5,
        "absorbed by the bottom side": 2.0,
        "absorbed by the left side": 3.0,
        "absorbed by the bottom side of the column": 1.5,
        "stored in springs of the left side": 0.25,
    }
    looks = {(line.get_color(), line.get_linestyle(), line.get_marker()) for line in drawn.values()}
    assert len(looks) == len(drawn)
    heads = [head for head, _ in columns_of(plot_energy(divided))]
    assert "absorbed by the left side: energy per metre of thickness (J/m)" in heads
    assert len(set(heads)) == len(heads)


@pytest.mark.parametrize(
    ("largest", "joule", "drawn"),
    [
        (0.0, "J", 0.0),
        (999.0, "J", 999.0),
        (1e3, "kJ", 1.0),
        (0.5, "mJ", 500.0),
        (3e-14, "nJ", 3e-5),
        (2e16, "TJ", 2e4),
    ],
)
def test_the_unit_of_the_axis_has_the_prefix(divided, largest, joule, drawn):
    with h5py.File(divided, "r+") as file:
        del file["energy/sides"]
        for name in COLUMNS:
            file["energy"][name][:] = largest if name == "kinetic" else 0.0
    upper = plot_energy(divided).axes[0]
    assert upper.get_ylabel() == f"energy per metre of thickness ({joule}/m)"
    assert [line.get_ydata()[-1] for line in upper.lines] == pytest.approx([drawn] if largest else [], rel=1e-12)
    assert not any(letter.isalpha() for letter in upper.yaxis.get_major_formatter()(20.0))


def test_units_and_the_name_are_told(cracked_run):
    figure = plot_energy(cracked_run)
    upper, lower = figure.axes
    assert upper.get_ylabel() in ("energy per metre of thickness (J/m)", "energy per metre of thickness (kJ/m)")
    assert lower.get_xlabel() == "time (ms)"
    assert figure.get_suptitle().startswith("cracked: ")


def test_what_is_negligible_is_left_out_and_no_two_colours_are_alike(cracked_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for name in COLUMNS:
            file["energy"][name][:] = 1.0
        file["energy/friction"][:] = 1e-7
    lines = plot_energy(run).axes[0].lines
    left_out = ("friction", "loads")  # the latter is a part of outside
    assert [line.get_label() for line in lines] == [label for name, label in COLUMNS.items() if name not in left_out]
    assert len({line.get_color() for line in lines}) == len(lines)


def test_a_run_without_entries_is_refused(small_run):
    with pytest.raises(CaseError, match="no entries in its energy ledger"):
        plot_energy(small_run)


def test_a_bar_keeps_its_books_in_its_own_words(spalled_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(spalled_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for name in COLUMNS:
            file["energy"][name][:] = 1.0
    upper = plot_energy(run).axes[0]
    assert upper.get_ylabel() == "energy (J)"
    labels = {line.get_label() for line in upper.lines}
    assert {
        "stored in local springs",
        "stored in peridynamic bonds",
        "taken by attenuation",
        "in: added by a change of method",
    } <= labels
    assert len({line.get_color() for line in upper.lines}) == len(upper.lines) == len(COLUMNS) - 1


def test_equal_shares_of_contacts_and_bonds_are_both_visible(cracked_run):
    lines = {line.get_label(): line for line in plot_energy(cracked_run).axes[0].lines}
    contact, bond = lines["stored in contacts"], lines["stored in bonds"]
    assert contact.get_linewidth() > 2.0 * bond.get_linewidth()
    assert contact.get_zorder() < bond.get_zorder()


def test_small_errors_have_their_power_at_every_tick(cracked_run):
    lower = plot_energy(cracked_run).axes[1]
    assert [lower.yaxis.get_major_formatter()(value) for value in (0.0, -2.5e-16)] == ["0", "−2.5e−16"]
    assert lower.yaxis.get_offset_text().get_text() == ""

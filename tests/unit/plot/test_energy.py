"""The ledger is drawn column by column, its error apart."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.energy import COLUMNS, NEGLIGIBLE, plot_energy
from dembound.results.datasets import datasets_of


def test_every_column_that_is_not_zero_is_a_line(cracked_run):
    figure = plot_energy(cracked_run)
    upper, lower = figure.axes
    drawn = {line.get_label(): line for line in upper.lines}
    with h5py.File(cracked_run) as file:
        ledger = {name: values[:] for name, values in datasets_of(file["energy"]).items()}
    assert ledger.keys() == {"time", "loads", "supplied", "error", *COLUMNS}
    largest = {name: np.abs(ledger[name]).max() for name in COLUMNS}
    for name, label in COLUMNS.items():
        if largest[name] > NEGLIGIBLE * max(largest.values()):
            np.testing.assert_array_equal(drawn.pop(label).get_data(), [ledger["time"] / 1e-3, ledger[name]])
    assert drawn == {}
    assert np.any(ledger["kinetic"])
    assert not np.any(ledger["damping"])
    (error,) = lower.lines
    np.testing.assert_array_equal(error.get_ydata(), ledger["error"] / ledger["supplied"][-1])


def test_units_and_the_name_are_told(cracked_run):
    figure = plot_energy(cracked_run)
    upper, lower = figure.axes
    assert (upper.get_ylabel(), lower.get_xlabel()) == ("energy per metre of thickness (J/m)", "time (ms)")
    assert figure.get_suptitle().startswith("cracked: ")
    assert [upper.yaxis.get_major_formatter()(value) for value in (0.0, 20.0, 5e4)] == ["0", "20", "50 k"]


def test_what_is_negligible_is_left_out_and_no_two_colours_are_alike(cracked_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(cracked_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for name in COLUMNS:
            file["energy"][name][:] = 1.0
        file["energy/friction"][:] = 1e-7
    lines = plot_energy(run).axes[0].lines
    assert [line.get_label() for line in lines] == [label for name, label in COLUMNS.items() if name != "friction"]
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
    assert len({line.get_color() for line in upper.lines}) == len(COLUMNS)


def test_equal_shares_of_contacts_and_bonds_are_both_visible(cracked_run):
    lines = {line.get_label(): line for line in plot_energy(cracked_run).axes[0].lines}
    contact, bond = lines["stored in contacts"], lines["stored in bonds"]
    assert contact.get_linewidth() > 2.0 * bond.get_linewidth()
    assert contact.get_zorder() < bond.get_zorder()


def test_small_errors_have_their_power_at_every_tick(cracked_run):
    lower = plot_energy(cracked_run).axes[1]
    assert [lower.yaxis.get_major_formatter()(value) for value in (0.0, -2.5e-16)] == ["0", "−2.5e−16"]
    assert lower.yaxis.get_offset_text().get_text() == ""

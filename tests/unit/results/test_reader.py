"""Records open by name, with their cracks and laws; histories have the units shown, and files are replaced whole."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError, RecordError
from dembound.results.histories import read_histories, read_side_history
from dembound.results.reader import cracks_until, energy_of, history_of, open_record, side_energies_of
from dembound.results.recording import LoadingCurve


def test_the_history_of_an_interrupted_run_ends_where_both_columns_do(small_run, tmp_path):
    path = tmp_path / "run.h5"
    path.write_bytes(small_run.read_bytes())
    with h5py.File(path, "r+") as file:
        file.attrs["complete"] = False
        file["histories/front/velocity"].resize(5, axis=0)
    with open_record(path) as file:
        time, velocity = history_of(file["histories/front"], "velocity")
        np.testing.assert_array_equal(time, file["histories/front/time"][:5])
    assert velocity.shape == (5, 3)


@pytest.mark.parametrize(
    ("column", "read"),
    [
        ("histories/front/velocity", lambda path, file: history_of(file["histories/front"], "velocity")),
        ("energy/kinetic", lambda path, file: energy_of(file)),
        ("energy/sides/left/absorbed", lambda path, file: side_energies_of(file)),
        ("boundaries/left/force", lambda path, file: read_side_history(path, "left")),
    ],
)
def test_numbers_that_are_not_finite_are_refused(small_run, tmp_path, column: str, read) -> None:
    path = tmp_path / "run.h5"
    for value in (np.nan, -np.inf):
        path.write_bytes(small_run.read_bytes())
        with h5py.File(path, "r+") as file:
            side = file["boundaries/left"]
            side.attrs["body_length"] = 2.5
            for name, width in (("force", 2), ("displacement", 3)):
                side[name] = np.zeros((5, width))
            side["time"] = np.arange(5.0)
            if column not in file:
                file[column] = np.zeros(5)
            file[column][3] = value
        reason = f"{column} has a number that is not finite in row 3"
        with pytest.raises(RecordError, match=reason), open_record(path) as file:
            read(path, file)


def test_cracks_are_those_up_to_a_time_that_time_included(cracked_run):
    with open_record(cracked_run) as file:
        times = file["cracks/time"][:]
        moment = times[len(times) // 2]
        found = cracks_until(file, moment)
        count = np.count_nonzero(times <= moment)
        for name, values in file["cracks"].items():
            np.testing.assert_array_equal(found[name], values[:count])


def ledger(path, **columns):
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file[f"energy/{name}"] = np.array(values)
    return path


def test_the_error_of_the_ledger_is_relative_to_all_that_was_supplied(tmp_path):
    path = tmp_path / "run.h5"
    for supplied, relative in (([0.0, 4.0, 4.0], [0.0, 0.25, 0.5]), ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0])):
        columns = {"time": [0.0, 1.0, 2.0], "error": [0.0, 1.0, 2.0], "supplied": supplied}
        with open_record(ledger(path, **columns)) as file:
            found = energy_of(file)
        assert found.pop("relative_error").tolist() == relative
        assert {name: values.tolist() for name, values in found.items()} == columns
    for columns in ({}, {"time": [], "outside": [], "load": [], "kinetic": [], "error": []}):
        ledger(path, **columns)
        with open_record(path) as file, pytest.raises(CaseError, match=r"run\.h5: has no entries in its energy ledger"):
            energy_of(file)


def test_accelerations_are_central_differences_of_the_velocity(small_run):
    history = read_histories(small_run, "acceleration")["front"]
    with h5py.File(small_run) as file:
        time, velocity = (file["histories/front"][name][:] for name in ("time", "velocity"))
    inner = (velocity[2:] - velocity[:-2]) / (time[2:] - time[:-2])[:, None]
    # times are whole multiples of a step, rounded: differences of theirs differ by 1e-13 of a step or less
    np.testing.assert_allclose(history.values[1:-1], inner, rtol=1e-9, atol=1e-9 * np.abs(inner).max())
    np.testing.assert_allclose(history.values[0], (velocity[1] - velocity[0]) / (time[1] - time[0]))


TIME = np.linspace(0.0, 3.0, 301)
RATE = 0.002


def curve(pressure: float = 0.0, crack_time: tuple[float, ...] = (0.8, 1.5, 2.5)) -> LoadingCurve:
    """Straight to the peak at 2 s, after which the stress falls; a stiffer foot up to a tenth of the peak."""
    strain = RATE * TIME
    stress = np.interp(TIME, [0.0, 0.1, 2.0, 3.0], [0.0, 4e6, 40e6, 10e6])
    times = TIME[::10]
    return LoadingCurve(
        kind="biaxial" if pressure else "ucs",
        time=TIME,
        stress=stress + pressure,
        pressure=pressure,
        strain=1.1 * strain,  # platens stiffen or soften the ends
        gauge_time=times,
        axial=RATE * times,
        lateral=0.3 * RATE * times,
        crack_time=np.array(crack_time),
        crack_shear=np.array([False, True, False])[: len(crack_time)],
    )


@pytest.mark.parametrize("pressure", [0.0, 5e6])
def test_moduli_are_slopes_of_the_middle_between_shares_of_the_peak(pressure: float) -> None:
    found = curve(pressure)
    young, poisson = found.elastic(0.15, 0.9)

    assert young == pytest.approx(36e6 / (1.9 * RATE), rel=1e-9)
    assert poisson == pytest.approx(0.3, rel=1e-9)
    assert found.strength == pytest.approx(40e6 + pressure)
    assert found.first_crack == pytest.approx(4e6 + 36e6 * 0.7 / 1.9 + pressure)
    assert found.rate == pytest.approx(1.1 * RATE)
    assert found.has_peak

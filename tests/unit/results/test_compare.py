"""Histories beside those of a reference run."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.results.compare import compare

TIME = np.linspace(0.0, 1.0, 101)


def record(path, name, histories, place=(0.0, 0.0)):
    """A record with histories of motion along x and y, name -> (time, x, y), of monitors in one place."""
    with h5py.File(path, "w") as file:
        file.attrs["name"], file.attrs["size"] = name, (10.0, 5.0)
        for monitor, (time, x, y) in histories.items():
            group = file.create_group(f"histories/{monitor}")
            group["time"] = time
            group["velocity"] = np.column_stack([x, y, np.zeros_like(time)])
            group.attrs["wanted"] = group.attrs["position"] = place
    return path


def test_differences_are_those_of_the_liveliest_component(tmp_path):
    nothing = np.zeros_like(TIME)
    reference = record(tmp_path / "a.h5", "a", {"P": (TIME, nothing + 0.1, TIME), "Q": (TIME, TIME, nothing)})
    # twice as finely sampled and half as long; x is wrong too, but y moves most
    time = np.linspace(0.0, 0.5, 101)
    histories = {"P": (time, np.zeros_like(time), 1.1 * time), "R": (time, time, time)}
    run = record(tmp_path / "b.h5", "b", histories, (1.0, 2.0))

    (found,) = compare(reference, [run], "velocity")

    assert (found.run, found.monitor, found.component) == ("b", "P", "y")
    assert found.rms == pytest.approx(0.1)
    assert found.peak == pytest.approx(0.1)
    assert (found.last, found.reference_last) == (pytest.approx(0.55), pytest.approx(0.5))
    assert (found.unit, found.place, found.reference_place) == ("m/s", "(1.00, 2.00) m", "(0.00, 0.00) m")


def test_runs_without_a_common_monitor_are_refused(tmp_path):
    paths = [record(tmp_path / f"{name}.h5", name, {name: (TIME, TIME, TIME)}) for name in "ab"]
    with pytest.raises(CaseError, match="has no monitor in common"):
        compare(paths[0], paths[1:], "velocity")


def test_a_reference_at_rest_is_refused(tmp_path):
    reference = record(tmp_path / "a.h5", "a", {"P": (TIME, 0.0 * TIME, 0.0 * TIME)})
    run = record(tmp_path / "b.h5", "b", {"P": (TIME, TIME, TIME)})
    with pytest.raises(CaseError, match="monitor P: its velocity is zero"):
        compare(reference, [run], "velocity")


def test_stresses_are_compared_in_megapascals(spalled_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(spalled_run.read_bytes())
    with h5py.File(run, "r+") as file:
        stress = file["histories/gauge/stress"]
        stress[:] = 1.25 * stress[:]
        last = stress[-1] / 1e6

    (found,) = compare(spalled_run, [run], "stress")

    assert (found.component, found.unit, found.place) == ("x", "MPa", "0.525 m")
    assert (found.rms, found.peak) == (pytest.approx(0.25), pytest.approx(0.25))
    assert (found.last, found.reference_last) == (pytest.approx(last), pytest.approx(last / 1.25))

"""Histories in the units they are shown in."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.results.histories import read_histories


def test_accelerations_are_central_differences_of_the_velocity(small_run):
    history = read_histories(small_run, "acceleration")["front"]
    with h5py.File(small_run) as file:
        time, velocity = (file["histories/front"][name][:] for name in ("time", "velocity"))
    inner = (velocity[2:] - velocity[:-2]) / (time[2:] - time[:-2])[:, None]
    # times are whole multiples of a step, rounded: differences of theirs differ by 1e-13 of a step or less
    np.testing.assert_allclose(history.values[1:-1], inner, rtol=1e-9, atol=1e-9 * np.abs(inner).max())
    np.testing.assert_allclose(history.values[0], (velocity[1] - velocity[0]) / (time[1] - time[0]))


def test_one_sample_has_no_acceleration(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        for name in ("time", "velocity", "displacement"):
            file["histories/front"][name].resize(1, axis=0)
    with pytest.raises(CaseError, match="fewer than two samples"):
        read_histories(run, "acceleration")


def test_places_are_that_of_the_particle_and_the_one_requested(small_run):
    history = read_histories(small_run, "velocity")["front"]
    with h5py.File(small_run) as file:
        place = file["histories/front"].attrs["position"]
    assert history.place == "({:.2f}, {:.2f}) m".format(*place)
    assert history.requested == "(2.40, 1.20) m"

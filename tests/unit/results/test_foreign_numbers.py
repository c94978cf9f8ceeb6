"""Numbers of a record that no run has: refused, with the place, before anything is made of them."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.errors import RecordError
from dembound.results.datasets import require_places
from dembound.results.reader import understood


@pytest.fixture
def record(tmp_path) -> Path:
    """Three particles, a monitor of the last, and one between nodes."""
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["particles/position"], file["particles/radius"] = np.zeros((3, 2)), np.ones(3)
        for name, particle in (("last", 2), ("between", -1)):
            file[f"histories/{name}/velocity"] = np.zeros((4, 3))
            file[f"histories/{name}"].attrs["particle"] = particle
    return path


def test_particles_of_no_size_and_monitors_of_none_are_refused(record) -> None:
    with h5py.File(record, "a") as file:
        require_places(file)
        for particle in (3, -2):
            file["histories/last"].attrs["particle"] = particle
            with pytest.raises(RecordError, match=f"histories/last is of particle {particle}, there are 3"):
                require_places(file)
        file["histories/last"].attrs["particle"] = 2
        for radius in (0.0, -0.5, np.nan):
            file["particles/radius"][1] = radius
            with pytest.raises(RecordError, match=f"particles/radius is {radius:g} in row 1"):
                require_places(file)


def test_a_failure_over_numbers_that_are_not_finite_names_them(record) -> None:
    with pytest.raises(RecordError, match="not of this version"), understood(record):
        raise ValueError("Axis limits cannot be NaN or Inf")
    with h5py.File(record, "a") as file:
        file["histories/last/velocity"][2, 1] = np.nan
    said = "histories/last/velocity has a number that is not finite in row 2"
    with pytest.raises(RecordError, match=said), understood(record):
        raise ValueError("Axis limits cannot be NaN or Inf")

"""Gauges and free ends read from text and from records."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.gauge.gauge_io import BarMetadata, read_free_end, read_gauge

VELOCITY = np.interp(np.arange(400), [0, 100, 140, 240, 270], [0.0, 0.0, 10.0, 4.0, 8.0])


@pytest.fixture
def text(felt, tmp_path):
    """A gauge's history in a text file, in MPa and positive in compression."""
    time, stress = felt()
    path = tmp_path / "gauge.csv"
    np.savetxt(path, np.column_stack([time, -stress]), delimiter=",")
    return path


@pytest.fixture
def record(felt, tmp_path):
    """The record of a run on a bar with two gauges, `near` at 0.6 m; `end` has velocities alone."""
    time, stress = felt()
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs.update({"name": "bar", "size": [0.99, 0.0], "density": 2620.0, "loaded": "left"})
        for name, place in (("near", 0.6), ("far", 0.9), ("end", 0.99)):
            group = file.create_group(f"histories/{name}")
            group.attrs["position"] = [place, 0.0]
            group["time"] = time
            group["velocity"] = np.resize(VELOCITY, len(time))[:, None] * [1.0, 2.0, 3.0]
            if name != "end":
                group["stress"] = 1e6 * stress
    return path


def test_a_record_knows_its_bar_unless_given_otherwise(record, felt):
    gauge = read_gauge(record, "near")
    np.testing.assert_array_equal(gauge.stress, 1e6 * felt()[1])
    assert (gauge.position, gauge.length, gauge.density) == (0.6, 0.99, 2620.0)
    moved = read_gauge(record, "near", position=0.5, length=1.0, density=2000.0)
    assert (moved.position, moved.length, moved.density) == (0.5, 1.0, 2000.0)
    with pytest.raises(CaseError, match="--monitor: is not named, must be one of far, near"):
        read_gauge(record)
    with pytest.raises(CaseError, match="--monitor: is end, must be between the bar's ends, which is far or near"):
        read_gauge(record, "end")
    with h5py.File(record, "r+") as file:
        file["histories/near"].attrs["range"] = "first"
    with pytest.raises(CaseError, match="has a bar of several ranges, must have one without interfaces"):
        read_gauge(record, "near")


MISSING = ["--position: is missing, must be the gauge's place (m) from the loaded end"]
MISSING += ["--length: is missing, must be that of the bar (m)"]


def test_the_free_end_is_a_monitor_or_a_file(record, text, tmp_path):
    np.savetxt(tmp_path / "end.txt", np.column_stack([np.arange(400), VELOCITY]))
    time, velocity = read_free_end(record, "end")
    with h5py.File(record) as file:
        np.testing.assert_array_equal(time, file["histories/end/time"][:])
    np.testing.assert_array_equal(velocity[:400], VELOCITY)
    time, velocity = read_free_end(text, str(tmp_path / "end.txt"))
    np.testing.assert_array_equal(time, np.arange(400))
    np.testing.assert_array_equal(velocity, VELOCITY)


@pytest.mark.parametrize("loaded", ["left", "right"])
def test_a_record_tells_of_its_bar(record, loaded):
    assert read_gauge(record, "near").metadata is None
    with h5py.File(record, "r+") as file:
        file.attrs.update({"wave_speed": 2740.0, "attenuation": 0.52, "ends": ["viscous", "fixed"], "loaded": loaded})
        file["cracks/time"] = np.empty(0)
    ends = ("viscous", "fixed") if loaded == "left" else ("fixed", "viscous")
    assert read_gauge(record, "near").metadata == BarMetadata(2740.0, 0.52, ends, np.inf)
    with h5py.File(record, "r+") as file:
        del file["cracks/time"]
        file["cracks/time"] = [4e-4, 3e-4, 5e-4]
    assert read_gauge(record, "near").metadata.broken == 3e-4

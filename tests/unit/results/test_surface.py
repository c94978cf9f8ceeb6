"""Amplification along the surface: ratios to the free field at the surface of each side."""

import csv

import h5py
import numpy as np
import pytest

from dembound.results.surface import amplification

STEP, COUNT = 1e-3, 2000


def pulse(gain: float, frequency: float = 5.0, at: float = 0.5) -> np.ndarray:
    """A Ricker wavelet (n,)."""
    x = (np.pi * frequency * (STEP * np.arange(COUNT) - at)) ** 2
    return gain * (1.0 - 2.0 * x) * np.exp(-x)


@pytest.fixture
def run(tmp_path):
    """A record of a body of 10 m × 8 m between columns of 8 m and 5 m, its ground lower at the right.

    The free field at the surface has pulses of 2 at the left and 4 at the right, the one at depth at the left 0.1.
    """
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs.update({"name": "steps", "corner": [0.0, 0.0], "size": [10.0, 8.0], "column": 3})
        disks = [[-2.0, 3.5], [-2.0, 7.5], [12.0, 4.5], [1.0, 7.5]]
        file["particles/position"], file["particles/radius"] = np.array(disks), np.full(4, 0.5)
        put(file, "row_10", (9.0, 4.5), x=6.0, y=2.0, end=0.3)
        put(file, "row_2", (4.0, 3.5), x=3.0, y=1.0, frequency=10.0)
        put(file, "row_1", (1.0, 7.5), x=3.0, y=-1.0, end=-0.2)
        put(file, "deep", (5.0, 1.0), x=1.0)
        put(file, "row_10.free_field", (12.0, 4.5), side="right", surface=5.0, x=4.0, end=0.1)
        put(file, "row_2.free_field", (-2.0, 3.5), side="left", surface=8.0, x=0.1)
        put(file, "row_1.free_field", (-2.0, 7.5), side="left", surface=8.0, x=2.0, y=1e-6)
    return path


def put(file, name, place, x=0.0, y=0.0, end=0.0, frequency=5.0, **attributes):
    """A history of pulses along x and y and of a displacement that reaches `end` along y."""
    group = file.create_group(f"histories/{name}")
    group.attrs.update({"position": place, "requested": place, **attributes})
    velocity, displacement = np.zeros((COUNT, 3)), np.zeros((COUNT, 3))
    velocity[:, 0], velocity[:, 1] = pulse(x, frequency), pulse(y, frequency)
    displacement[COUNT // 2 :, 1] = end
    group["time"], group["velocity"], group["displacement"] = STEP * np.arange(COUNT), velocity, displacement


def test_ratios_are_to_the_surface_of_the_own_side(run):
    found = amplification(run)
    assert found.names == ["row_1", "row_2", "row_10"]  # the row, in the order of x
    assert found.fields == ["row_1.free_field", "row_1.free_field", "row_10.free_field"]
    assert found.over_size == (False, True)
    np.testing.assert_allclose(found.peaks["velocity"], [[1.5, 0.5], [1.5, 0.5], [1.5, 0.5]])
    # (frequency 10 Hz over 5 Hz) doubles the acceleration of row_2
    np.testing.assert_allclose(found.peaks["acceleration"][:, 0], [1.5, 3.0, 1.5], rtol=2e-3)
    np.testing.assert_allclose(found.at_end, [[0.0, -0.2], [0.0, 0.0], [0.0, 0.2]], atol=1e-12)
    np.testing.assert_allclose(found.spectra[[0, 2], :, 0], 1.5, rtol=1e-6)
    np.testing.assert_allclose(found.spectra[[0, 2], :, 1], 0.5, rtol=1e-6)
    assert found.deep == 0.0
    # a Ricker spectrum f²/f₀³ exp(−f²/f₀²) of 10 Hz over one of 5 Hz, times 1.5: 0.19 exp(0.03 f²) is 1 at 7.44 Hz
    ratio = 1.5 / 8.0 * np.exp(0.03 * found.frequency**2)
    near = np.abs(found.frequency - 7.44).argmin()
    assert found.spectra[1, near, 0] == pytest.approx(ratio[near], rel=0.03)  # of smoothing


def test_the_free_field_may_be_named_and_monitors_chosen(run):
    found = amplification(run, ["row_10", "deep"], "row_1")
    assert (found.names, found.over_size) == (["deep", "row_10"], (False, False))
    np.testing.assert_allclose(found.peaks["velocity"], [[1.0 / 3.0, 0.0], [2.0, 2.0]])
    with h5py.File(run, "r+") as file:
        del file["histories/row_1"], file["histories/row_1.free_field"]
    found = amplification(run, ["row_2", "row_10"])
    assert found.deep == pytest.approx(4.5)
    assert list(found.notes())[-1].startswith("the free field is up to 4.5 m below the surface")


def test_the_command_leaves_picture_and_table(run, dembound, tmp_path):
    answer = dembound("signals", run, "--show", "surface", "-o", "ridge.png", "--monitor", "row")
    assert answer.code == 0, answer.err
    assert answer.out.splitlines()[:4] == [
        "wrote ridge.png",
        "wrote ridge.csv",
        "free field: row_1.free_field at y = 7.5 m, of 2 monitors",
        "free field: row_10.free_field at y = 4.5 m, of 1 monitor",
    ]
    heads, *rows = csv.reader((tmp_path / "ridge.csv").open(encoding="utf-8"))
    assert [row[heads.index("peak velocity x over free field's x (–)")] for row in rows] == ["1.5"] * 3
    answer = dembound("signals", run, run, "--show", "surface", "--quantity", "velocity", "--component", "rotation")
    assert answer.code != 0
    assert [line.partition(":")[0] for line in answer.err.splitlines()] == ["--quantity", "--component", "--show"]

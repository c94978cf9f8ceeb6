"""Breaks or slip beside a continuum, which stays elastic, cause a warning; those far from it do not."""

import json
import re

import h5py
import numpy as np

from dembound.kinds import with_changes
from dembound.running import run_case

PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.02}
BONDS = {"law": "linearpbond", "elastic_start": False, "emod": 0.0, "pb_emod": 2e9, "pb_ten": 1e6, "pb_coh": 1e6}
CONTACTS = {"law": "linearpbond", "elastic_start": False, "emod": 2e9, "pb_emod": 1e9, "fric": 0.1}
PUSH = [4e6, 0.0]
"""N/m, on a disk with four bonds of 1 MN/m, before it hits others."""

SIZE = (16.0, 10.0)


def run(lab, tmp_path, material, force, place):
    """Warnings, and the record, of 16 × 10 disks of 1 m with a continuum on three sides, one of which is loaded."""
    case = lab.case(
        "A",
        SIZE,
        radius=0.5,
        held=(),
        material=material,
        boundary=dict.fromkeys(("left", "right", "bottom"), "outside"),
        wave=PULSE,
        load=[{"name": "blow", "position": place, "force": force, "wave": "pulse"}],
        duration=0.012,
    )
    case = with_changes(case, {"output.pictures": False, "output.snapshots": 1})
    folder = run_case(case, tmp_path)
    said = json.loads((folder / "summary.json").read_text())["warnings"]
    with h5py.File(folder / "run.h5") as file:
        cracks = {name: values[:] for name, values in file["cracks"].items()}
        position = file["particles/position"][:]
    return [line for line in said if "stays elastic" in line], cracks, position


def near(cracks, position) -> np.ndarray:
    """Cracks (k,) bool with a disk at most two diameters from one in the outermost rows left, right and below."""
    x, y = position[cracks["particles"]].transpose(2, 0, 1)
    return ((x < 3.0) | (x > SIZE[0] - 3.0) | (y < 3.0)).any(axis=1)


def numbers(line: str) -> list[float]:
    """Time and place in a warning."""
    return [float(text) for text in re.search(r"t = (\S+) s near \((\S+), (\S+)\) m", line).groups()]


def test_a_crack_is_warned_of_near_a_tie_with_its_time_and_place_and_nowhere_else(lab, tmp_path) -> None:
    lines, cracks, position = run(lab, tmp_path / "far", BONDS, PUSH, [8.5, 7.5])
    assert len(cracks["time"]) > 0
    assert not near(cracks, position).any()
    assert lines == []
    (line,), cracks, position = run(lab, tmp_path / "near", BONDS, PUSH, [1.5, 7.5])
    found = near(cracks, position)
    first = np.flatnonzero(found)[np.argmin(cracks["time"][found])]
    assert line.startswith("boundary.left: ")
    assert "broke at" in line
    np.testing.assert_allclose(numbers(line), [cracks["time"][first], *cracks["position"][first]], rtol=1e-3)


def test_slip_near_ties_is_warned_of(lab, tmp_path) -> None:
    """Nothing presses the contacts together, so that they slide as soon as they are sheared, within the pulse."""
    place = [14.5, 7.5]
    lines, cracks, _ = run(lab, tmp_path, CONTACTS, [0.0, -1e5], place)
    (line,) = [each for each in lines if each.startswith("boundary.right: ")]
    time, x, y = numbers(line)
    assert len(cracks["time"]) == 0
    assert "opened or slid by" in line
    assert 0.0 < time <= 0.012
    assert x > SIZE[0] - 3.0
    assert abs(y - place[1]) < 3.0

"""Debris in the results of a run: at snapshots, in the summary and in words, until rest; means over polygons."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from small_cases import DROPPED, small

from dembound.disks.debris import STEPS
from dembound.kinds.disks.debris import debris_in_words
from dembound.results.results import Results
from dembound.results.summary import end_in_words
from dembound.running import run_case


@pytest.fixture(scope="module")
def dropped(tmp_path_factory) -> Path:
    return run_case(small(DROPPED), tmp_path_factory.mktemp("dropped"))


def test_the_run_ends_at_rest_and_says_what_fell(dropped: Path) -> None:
    """All 16 disks fall by 1 m: mgh of the block is the energy of the fall, within what they then fall or rise."""
    summary = Results(dropped).summary
    found, ended = summary["debris"], summary["ended"]
    assert ended["why"] == "rest"
    assert ended["time"] < 20.0
    # one look later at most
    assert 0.3 <= ended["time"] - found["rest"] < 0.3 + STEPS * summary["time_step"]
    mass = 2500.0 * 4.0
    assert found["mass"] == pytest.approx(mass, rel=1e-12)
    assert found["fall"] == pytest.approx(mass * 9.81, rel=0.5)
    assert found["kinetic"] < 1e-3 * found["fall"]
    assert (found["left"], found["right"]) == (None, None)
    largest = np.sqrt(4.0 * 4.0 / np.pi)  # of 2 m × 2 m
    pieces = {"count": 1, "largest": largest, "share": 1.0, "singles": 0.0, "d50": largest, "d80": largest}
    assert found["fragments"] == pytest.approx(pieces, rel=1e-12)
    assert end_in_words(summary)[0].startswith("ended at ")
    moved, pieces = debris_in_words(found)
    assert moved.startswith("100 % of the mass moved by more than a diameter; at rest from ")
    assert pieces.startswith("1 fragments of two disks or more, the largest 2.26 m, and ")


def test_the_record_has_debris_at_all_snapshots(dropped: Path) -> None:
    summary = Results(dropped).summary["debris"]
    with h5py.File(dropped / "run.h5") as file:
        group, last = file["debris"], len(file["snapshots"]) - 1
        assert group["time"][-1] == file[f"snapshots/{last:04d}"].attrs["time"]
        assert group["mass"][-1] == summary["mass"]
        np.testing.assert_array_equal(group["centre"][-1], summary["centre"])
        for name, value in summary["fragments"].items():
            assert group[f"fragments/{name}"][-1] == value
        of_last = group["sizes/snapshot"][:] == last
        assert group["sizes/disks"][:][of_last].sum() == 16
        assert group["sizes/mass"][:][of_last].sum() == pytest.approx(summary["mass"])
        assert np.isnan(group["right/x99"][:]).all()


def test_a_polygon_has_the_mean_motion_of_its_disks(dropped: Path) -> None:
    found = Results(dropped)
    history, snapshot = found.histories["upper"], found.snapshots[-2]
    inside = found.particles["position"][:, 1] > 1.2
    sample = round(snapshot.attributes["time"] / found.attributes["time_step"])
    np.testing.assert_allclose(
        history["displacement"][sample], snapshot["displacement"][inside].mean(axis=0), rtol=1e-12
    )
    np.testing.assert_allclose(history.attributes["position"], [1.0, 1.5], rtol=1e-12)


def test_a_run_in_which_nothing_falls_is_warned_of(tmp_path: Path) -> None:
    wall = {"name": "floor", "points": [[-1.0, 0.0], [3.0, 0.0]], "dp_nratio": 0.3}
    summary = Results(
        run_case(small(DROPPED | {"wall": [wall], "run": {"duration": 0.5, "until": "rest"}}), tmp_path)
    ).summary
    assert summary["ended"] is None
    said = 'run.until: is "rest", but the run took its whole duration, 0.5 s: nothing fell'
    assert any(each.startswith(said) for each in summary["warnings"])

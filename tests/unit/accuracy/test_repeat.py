"""Repeated runs with cracks: common cracks of both, and equality of their problems."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from small_cases import PUSHED, TORN, small

from dembound.accuracy import repeat
from dembound.accuracy.estimate import estimate_results
from dembound.accuracy.repeat import Cracked, Repeat, repeated
from dembound.errors import RunError
from dembound.running import run_case
from dembound.running.recorded import recorded_case

BREAKING = TORN | {"output.estimate": True, "run.checkpoint": 100.0}
"""Changes with keys that a second run must not have."""


@pytest.fixture(scope="module")
def torn(tmp_path_factory) -> Path:
    """The folder of a run whose bonds break."""
    return run_case(small(PUSHED, "torn", BREAKING), tmp_path_factory.mktemp("torn"))


def cracked(x: list[float], size: float = 1.0) -> Cracked:
    """Cracks on a line."""
    return Cracked(np.column_stack([x, np.zeros(len(x))]), np.ones(len(x)), 2.0 * len(x), "J/m", size, 0.1)


def test_cracks_in_common_are_counted_in_both_runs_and_the_radius_leaves_out_the_farthest() -> None:
    """Cracks that only one of the runs has reduce the common share, whichever run has more."""
    first, second = cracked([0.0, 5.0, 5.9, 9.0]), cracked([1.0, 5.5, 20.0])
    for own, other in ((first, second), (second, first)):
        assert Repeat(own, other, {}, 1.0).common == pytest.approx(5.0 / 7.0)  # 0, 5, 5.9 and 1, 5.5
    assert Repeat(first, cracked([]), {}, 1.0).common == 0.0
    assert Repeat(first, first, {}, 1.0).common == 1.0
    assert Repeat(cracked([0.0]), cracked([1.06]), {}, 1.0).common == 0.0
    line = cracked(np.linspace(-10.0, 10.0, 2001).tolist())
    assert line.radius == pytest.approx(9.5, abs=0.01)
    assert cracked([]).radius is None
    assert cracked([3.0]).radius == 0.0


def test_a_repeat_with_the_same_step_is_the_same_run(torn) -> None:
    """Duration, laws and output of histories are also those of the run."""
    record = torn / "run.h5"
    same = repeated(recorded_case(record), record, Cracked.of(record), 1.0)

    assert np.array_equal(same.other.places, same.own.places)
    assert np.array_equal(same.other.times, same.own.times)
    assert (same.common, same.cost) == (1.0, 1.0)
    assert same.other.energy == same.own.energy > 0.0
    assert same.changes == {name: {"velocity": 0.0, "displacement": 0.0} for name in ("front", "back")}


@pytest.fixture
def beside(tmp_path, monkeypatch) -> Path:
    """The folder in which second runs are made, and removed afterwards."""
    make = repeat.TemporaryDirectory.__init__
    monkeypatch.setattr(repeat.TemporaryDirectory, "__init__", lambda self, **more: make(self, **more, dir=tmp_path))
    return tmp_path


def test_a_repeat_is_in_the_estimate_and_leaves_no_run_behind(torn, beside) -> None:
    before = sorted(torn.parent.iterdir())
    found = estimate_results(torn, repeat=True)

    assert sorted(torn.parent.iterdir()) == before
    assert not any(beside.iterdir())
    entry = json.loads((torn / "summary.json").read_text(), parse_constant=pytest.fail)["error_estimate"]
    assert entry["repeat"] == found.repeat.summary()
    own, other = entry["repeat"]["this_run"], entry["repeat"]["second_run"]
    assert other["time_step"] == pytest.approx(0.98 * own["time_step"], rel=1e-12)
    assert own["cracks"] == len(Cracked.of(torn / "run.h5")) > 10
    assert entry["repeat"]["within"] == pytest.approx(1.05 * 0.5)
    assert entry["cost"] > 1.0
    assert any(line.startswith("motion after") for line in entry["not_estimated"])
    with h5py.File(torn / "estimate.h5") as file:
        assert len(file["repeat/time"]) == len(file["repeat/position"]) == other["cracks"]


def test_a_repeat_that_fails_leaves_the_results_as_they_are(torn, beside, monkeypatch) -> None:

    def half_written(case, folder):
        (folder / "torn.partial").mkdir()
        raise RunError("the motion grows without bound")

    monkeypatch.setattr(repeat, "run_case", half_written)
    before = {path: path.read_bytes() for path in torn.iterdir() if path.is_file()}
    with pytest.raises(RunError):
        estimate_results(torn, repeat=True)

    assert not any(beside.iterdir())
    assert {path: path.read_bytes() for path in torn.iterdir() if path.is_file()} == before

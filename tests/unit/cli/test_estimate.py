"""The command estimate, and run --estimate."""

import json

import h5py
import numpy as np
from small_cases import PUSHED, TORN, small

LOOSE = {"boundary.right.beta_p": 0.5, "boundary.right.beta_s": 0.5, "run.duration": 0.03}
"""Dashpots that return a third of waves, and time for it."""


def written(tmp_path, **changes) -> None:
    """A case file."""
    (tmp_path / "bar.toml").write_text(small(PUSHED, "bar", LOOSE | changes).text)


def test_a_run_is_estimated_and_drawn(dembound, tmp_path):
    written(tmp_path)
    answer = dembound("run", "bar.toml", "--estimate")
    assert answer.code == 0, answer.err
    folder = tmp_path / "results" / "bar"
    found = json.loads((folder / "summary.json").read_text())["error_estimate"]
    # the right side returns (1 − β)/(1 + β) = 1/3 of what arrives, which adds to the motion beside it
    assert 0.15 < found["monitors"]["back"]["velocity"]["by"]["sides"] < 0.5
    with h5py.File(folder / "estimate.h5") as file, h5py.File(folder / "run.h5") as run:
        times = [each["histories/back/time"][:] for each in (file, run)]
        assert abs(times[0][-1] - times[1][-1]) < 2 * max(np.diff(each).max() for each in times)
        assert np.abs(file["histories/back/velocity/error of sides"][:]).max() > 0.05
    assert dembound("run", "bar.toml", "--set", "output.pictures=false").code == 0
    assert not (folder / "estimate.h5").exists()  # it was that of another run


def test_what_cannot_be_estimated_is_one_line(dembound, tmp_path):
    written(tmp_path, **{"output.pictures": False, "monitor": []})
    assert dembound("run", "bar.toml").code == 0
    without, needs = "has no monitor whose error could be estimated", "; give a [[monitor]]"
    for words, said in (
        (("run", "bar.toml", "--estimate"), [f"--estimate: bar {without}{needs}"]),
        (
            ("run", "bar.toml", "--set", "output.estimate=true"),
            [f"bar: output.estimate: is true, but the case {without}{needs}"],
        ),
        (
            ("estimate", "nowhere", "results/bar"),
            [
                "nowhere: contains no results, must be a folder with run.h5 or calibration.h5",
                f"results/bar/run.h5: {without}",
            ],
        ),
    ):
        answer = dembound(*words)
        assert (answer.code, answer.err.splitlines()) == (2, said)


def test_a_run_with_cracks_is_repeated_on_request(dembound, tmp_path):
    (tmp_path / "torn.toml").write_text(small(PUSHED, "torn", TORN).text)
    assert "bonds break: which ones" in dembound("run", "torn.toml", "--estimate").out
    answer = dembound("estimate", "results/torn", "--repeat")
    assert answer.code == 0, answer.err
    said = " ".join(answer.out.split())
    assert "repeated at 0.98 of the time step: " in said
    assert "bonds break: which ones" not in said

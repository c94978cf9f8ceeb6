"""The commands advise and estimate, and the options --error, --keep and --estimate of run."""

import json
import signal

import h5py
import numpy as np
import pytest
from small_cases import PUSHED, TORN
from small_cases import small as small_case
from unit.accuracy.test_advise import BAR, small

from dembound.accuracy.of_disks import judge
from dembound.cli.advise import bound_of, name_within
from dembound.errors import CaseError
from dembound.interrupts import Stopped


@pytest.fixture
def case(tmp_path):
    """A bar whose dashpots return a quarter of the wave."""
    path = tmp_path / "bar.toml"
    path.write_text(small(BAR).text, encoding="utf-8")
    return path


def test_bounds_are_shares_or_per_cent_and_names_have_them() -> None:
    assert bound_of(None) is None
    for text, bound, name in (
        *(("1%", 0.01, "bar_1pct"), ("0.01", 0.01, "bar_1pct"), (" 2.5 %", 0.025, "bar_2_5pct")),
        *(("0.003", 0.003, "bar_0_3pct"), ("12.5 %", 0.125, "bar_12_5pct"), ("1e-6", 1e-6, "bar_0_0001pct")),
        ("10%", 0.1, "bar_10pct"),
    ):
        assert bound_of(text) == pytest.approx(bound)
        assert name_within("bar", bound_of(text)) == name
    for text in ("0", "1", "100%", "-1%", "nan", "small", "1%%", "%", ""):
        with pytest.raises(CaseError, match=r"^--error: is "):
            bound_of(text)


def test_a_run_has_the_chosen_case_and_its_estimate(dembound, case, tmp_path) -> None:
    answer = dembound("run", case, "--error", "5%", "--keep", "packing", "--set", "output.pictures=false")
    assert answer.code == 0
    assert "bar_5pct: boundary.right" in answer.out
    assert "half_mass = true" in answer.out
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["bar_5pct"]  # beside a run of the case itself
    summary = json.loads((tmp_path / "results/bar_5pct/summary.json").read_text())
    found = [each["velocity"]["of"]["rock"]["value"] for each in summary["error_estimate"]["monitors"].values()]
    assert 0.0 < max(found) < 0.05


def test_a_case_is_written_with_the_lines_that_differ(dembound, case) -> None:
    case.write_text(f"# my bar\n{case.read_text()}")
    answer = dembound("advise", case, "--error", "5%", "--keep", "packing")
    assert answer.code == 0, answer.err
    written = case.with_name("bar_5pct.toml")
    assert answer.out.endswith(f"wrote {written}\n")
    before, after = (path.read_text().splitlines() for path in (case, written))
    assert after[0] == "# my bar"
    new = [line for line in after if line not in before]
    assert len(new) <= 4


@pytest.mark.slow
def test_a_bound_that_nothing_holds_ends_with_the_best(dembound, case, tmp_path) -> None:
    keep = ("--error", "1%", "--keep", "packing", "--set", "boundary.right.beta_p=0.6")
    for command in ("run", "advise"):
        answer = dembound(command, case, *keep)
        assert answer.code == 3
        assert "bar: no choice keeps 1 %; the best of" in answer.err.replace("bar_1pct", "bar")
        assert "next: most is by sides, at back; less with wider ground" in answer.err
    assert not (tmp_path / "results").exists()
    assert not case.with_name("bar_1pct.toml").exists()


def _stop(*arguments, **more):
    raise Stopped(signal.SIGINT)


def test_what_is_known_remains_of_advice_that_is_interrupted(dembound, case, monkeypatch) -> None:
    answers = iter([judge._best])
    monkeypatch.setattr(judge, "_best", lambda *given: next(answers, _stop)(*given))
    answer = dembound("advise", case)
    assert answer.code == 130
    assert "errors: RMS over RMS" in answer.out
    assert [line[:12] for line in answer.out.splitlines() if line[:12].endswith(" %")] == [f"{'10 %':>12}"]
    assert answer.err.endswith("bar: stopped; missing: the cheapest choices within 3 %, 1 %, 0.3 %\n")


LOOSE = {"boundary.right.beta_p": 0.5, "boundary.right.beta_s": 0.5, "run.duration": 0.03}
"""Dashpots that return a third of waves, and time for it."""


def written(tmp_path, **changes) -> None:
    """A case file."""
    (tmp_path / "bar.toml").write_text(small_case(PUSHED, "bar", LOOSE | changes).text)


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


@pytest.mark.slow
def test_a_run_with_cracks_is_repeated_on_request(dembound, tmp_path):
    (tmp_path / "torn.toml").write_text(small_case(PUSHED, "torn", TORN).text)
    assert "bonds break: which ones" in dembound("run", "torn.toml", "--estimate").out
    answer = dembound("estimate", "results/torn", "--repeat")
    assert answer.code == 0, answer.err
    said = " ".join(answer.out.split())
    assert "repeated at 0.98 of the time step: " in said
    assert "bonds break: which ones" not in said

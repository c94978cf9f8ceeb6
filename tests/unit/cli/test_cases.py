"""What run prints after a run, and before one that replaces results."""

import json


def test_a_run_ends_with_peaks_files_and_the_next_command(dembound, written, tmp_path) -> None:
    answer = dembound("run", written())
    found = json.loads((tmp_path / "results" / "bar" / "summary.json").read_text())["monitors"]["middle"]
    assert answer.out.splitlines()[1:] == [
        "  monitor  component  peak (mm/s)  at (ms)",
        f"  middle         v_x  {1e3 * found['peak_velocity']:>11.3g}  {1e3 * found['peak_time']:>7.3g}",
        "bar: results in results/bar",
        "  run.h5, summary.json, paraview/",
        "  next: dembound report results/bar",
        "        dembound estimate results/bar",
    ]


def test_nothing_is_replaced_unseen(dembound, written, tmp_path) -> None:
    path = written()

    def said(*words: str) -> list[str]:
        lines = dembound("run", path, *words).err.splitlines()
        return [line for line in lines if "replaces" in line or "anew" in line]

    then = "when it is complete; to keep both, stop it and give --name or --output"
    assert said() == []
    assert said() == [f"bar: replaces results/bar (of the same case) {then}"]
    changed = ("--set", "run.safety=0.5", "--set", "run.duration=0.02")
    assert said(*changed) == [f"bar: replaces results/bar (with another run.duration, run.safety) {then}"]
    (tmp_path / "results" / "bar").rename(tmp_path / "results" / "bar.partial")
    stopped = "the stopped run in results/bar.partial, which dembound resume would have continued"
    assert said() == [f"bar: begins anew, without {stopped}"]

"""What run prints before and after a run, and how any command ends: one line with remedies, and its exit code."""

import errno
import json
import signal
import subprocess
import sys

from dembound.running import job

IMPORTED = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # tests may be run where it is ignored
class Signals:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Signals())
sys.argv = ["dembound", "dispersion", "--horizon", "0"]
from dembound.__main__ import main
main()
"""
"""A command that receives a signal as it begins to import numpy."""


def test_a_signal_during_imports_has_its_line_and_code() -> None:
    done = subprocess.run([sys.executable, "-c", IMPORTED], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (128 + signal.SIGINT, "dembound: stopped\n")


def test_a_full_disk_says_how_to_continue(dembound, written, tmp_path, monkeypatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "results/bar.partial/paraview/particles_0000.vtu")

    monkeypatch.setattr(job, "write_paraview", full)
    answer = dembound("run", written())
    lines = [line for line in answer.err.splitlines() if "warning" not in line]

    assert answer.code == 5
    assert lines == [
        "results/bar.partial/paraview/particles_0000.vtu: No space left on device",
        "bar: histories so far are in results/bar.partial",
        "bar: to continue: dembound resume results/bar.partial",
    ]
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    resumed = dembound("resume", "results/bar.partial")
    assert resumed.code == 0
    assert "bar.partial" not in resumed.out + resumed.err


def test_names_that_not_all_systems_can_have_are_refused(dembound, written, tmp_path) -> None:
    path = written()
    for name in ("", "CON", "nul.txt", "bar.", "bar ", "a:b", "a/b", "a\\b", "..", "a*"):
        answer = dembound("run", path, "--name", name)
        assert answer.code == 2
        (line,) = answer.err.splitlines()
        assert line.startswith(f"--name: is {name!r}, ")
    assert not (tmp_path / "results").exists()


def test_a_wave_file_that_is_no_file_is_called_so(dembound, written, tmp_path) -> None:
    (tmp_path / "waves").mkdir()
    case = written()
    case.write_bytes(b"\xef\xbb\xbf" + case.read_bytes())  # with a byte order mark
    assert dembound("check", case).code == 0
    for path, problem in (("waves", "is not a regular file"), ("/dev/zero", "is not a regular file"), ("w.txt", "")):
        answer = dembound("check", case, "--set", f'wave.pulse={{type="file",path="{path}"}}')
        assert answer.code == 2
        (line,) = answer.err.splitlines()
        assert line.endswith(problem)
        assert ("no file" in line) == (problem == "")


def test_a_changed_rerun_does_not_replace_the_record_it_is_read_from(dembound, written, tmp_path) -> None:
    assert dembound("run", written()).code == 0
    record = tmp_path / "results" / "bar" / "run.h5"
    before = record.read_bytes()
    change = ("--set", "run.safety=0.5")
    for arguments in (
        ("results/bar", *change),
        (tmp_path / "results" / "bar", *change, "--output", "./results", "--name", "bar"),
    ):
        answer = dembound("rerun", *arguments)
        assert answer.code == 2
        (line,) = answer.err.splitlines()
        assert line.startswith("--set: would replace ")
        assert line.endswith("bar/run.h5, from which the case is read; give another --name or --output")
    assert record.read_bytes() == before

    assert dembound("rerun", "results/bar", "--name", "half", *change).code == 0


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

"""Whatever fails during a run, its record can be read, its checkpoint continued, and earlier results remain."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np
import pytest
from small_cases import PULLED, small

from dembound.casefile import Case
from dembound.errors import CaseError, RecordError
from dembound.interrupts import Stopped
from dembound.results import recorder
from dembound.results.folder import LOCK
from dembound.results.reader import open_record
from dembound.running import job, resume_case, run_case
from dembound.running.recorded import recorded_case

OFTEN = {"run.duration": 0.02, "run.checkpoint": 1e-9, "output.snapshots": 3, "output.energy_interval": 1e-2}
"""Changes of a bar: a longer run, with a checkpoint after each of some ten blocks of steps."""


def pulled(name: str = "bar", **changes: object) -> Case:
    """The pulled bar, with keys changed: table__key for table.key."""
    return small(PULLED, name, OFTEN | {key.replace("__", "."): value for key, value in changes.items()})


@pytest.fixture(scope="module")
def case():
    """A case whose run returns often from the loop, and writes its record and a checkpoint each time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recorder, "KEPT_SECONDS", 0.0)
        yield pulled()


@pytest.fixture(scope="module")
def finished(case, tmp_path_factory) -> Path:
    """The folder of its results, to be read only."""
    return run_case(case, tmp_path_factory.mktemp("whole"))


@pytest.fixture(scope="module")
def whole(finished) -> np.ndarray:
    return history(finished / "run.h5")


@pytest.fixture
def folder(finished, tmp_path) -> Path:
    """A copy of its results."""
    return shutil.copytree(finished, tmp_path / "bar")


@contextmanager
def largest_file(size: int):
    """Limit the size of files to `size` bytes: further writes fail, as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def history(record) -> np.ndarray:
    with open_record(record) as file:
        return file["histories/gauge/velocity"][()]


def test_a_full_disk_loses_nothing_that_was_written(case, finished, whole, tmp_path) -> None:
    largest = max(path.stat().st_size for path in finished.rglob("*"))
    reached = set()
    for number, size in enumerate(np.linspace(100, 0.95 * largest, 3, dtype=int)):
        results = tmp_path / str(number)
        earlier = shutil.copytree(finished, results / "bar") / "run.h5"
        with largest_file(int(size)), pytest.raises(OSError, match=r"File too large|larger than") as failure:
            run_case(case, results)
        assert str(failure.value.filename).startswith(str(results / "bar.partial"))
        assert np.array_equal(history(earlier), whole)
        partial = results / "bar.partial"
        if (partial / "run.h5").is_file() and (partial / "run.h5").stat().st_size > 0:
            kept = history(partial / "run.h5")
            assert np.array_equal(kept, whole[: len(kept)])
            reached.add(len(kept))
        again = resume_case(partial) if (partial / "checkpoint.npz").is_file() else run_case(case, results)
        assert np.array_equal(history(again / "run.h5"), whole)
    assert reached


def test_files_that_no_run_has_written_are_kept(case, folder, tmp_path) -> None:
    left = shutil.copytree(folder, tmp_path / "bar.replaced")
    (folder / "notes.txt").write_text("mine")
    (folder / "paraview" / "state.pvsm").write_text("mine")
    (folder / "paraview" / "bar_0007.vtu").write_text("old")  # of an earlier run with more snapshots
    (tmp_path / "bar.partial").mkdir()
    (tmp_path / "bar.partial" / "seen.txt").write_text("mine")
    for both in (True, False):  # the process had ended after, or before the new folder had its name
        if not both:
            folder.rename(left)
        (left / f"left{both}.txt").write_text("mine")
        assert run_case(case, tmp_path) == folder
        for name in ("notes.txt", "paraview/state.pvsm", "seen.txt", f"left{both}.txt"):
            assert (folder / name).read_text() == "mine"
        assert not (folder / "paraview" / "bar_0007.vtu").exists()
        assert [path.name for path in tmp_path.iterdir()] == ["bar"]


def test_two_runs_of_one_name_do_not_mix(case, tmp_path) -> None:
    other = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path / "bar.partial")], stdout=subprocess.PIPE, text=True
    )
    assert other.stdout is not None
    assert other.stdout.readline() == "locked\n"
    try:
        with pytest.raises(CaseError, match=r"bar\.partial: is being written by another run"):
            run_case(case, tmp_path)
    finally:
        other.kill()
        other.wait()
    # the lock of a process that was killed holds nobody up
    assert (tmp_path / "bar.partial" / LOCK).is_file()
    assert run_case(case, tmp_path).name == "bar"


HOLD = """
import sys, time
from pathlib import Path
from dembound.results.folder import Folder
partial = Path(sys.argv[1])
with Folder(partial.parent, partial.stem).writing(anew=True):
    print("locked", flush=True)
    time.sleep(60)
"""


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM])
def test_a_signal_ends_a_run_with_a_checkpoint(case, whole, tmp_path, monkeypatch, number) -> None:
    class Signalled(job.Checkpoints):
        """A run that receives a signal in one of its blocks."""

        def observe(self, run, record) -> None:
            if run.state.step > 1000:
                os.kill(os.getpid(), number)
                time.sleep(0.0)  # the handler is called between two instructions
            super().observe(run, record)

    monkeypatch.setattr(job, "Checkpoints", Signalled)
    at_first = signal.signal(number, signal.default_int_handler)  # tests may be run where hangups are ignored
    try:
        with pytest.raises(Stopped) as stop:
            run_case(case, tmp_path)
        assert signal.getsignal(number) is signal.default_int_handler
    finally:
        signal.signal(number, at_first)
    monkeypatch.undo()

    assert stop.value.exit_code == 128 + number
    kept = history(tmp_path / "bar.partial" / "run.h5")
    assert 1000 < len(kept) < len(whole)
    assert np.array_equal(history(resume_case(tmp_path / "bar.partial") / "run.h5"), whole)


def test_what_cannot_be_resumed_is_refused_with_the_reason(folder, tmp_path) -> None:
    with pytest.raises(CaseError, match="nothing: there is no such folder of results"):
        resume_case(tmp_path / "nothing")
    with pytest.raises(CaseError, match=r"is complete; a later time, until, continues it"):
        resume_case(folder)
    with pytest.raises(CaseError, match=r"until: is 0.001 s, must be after 0.02"):
        resume_case(folder, until=0.001)

    checkpoint = (folder / "checkpoint.npz").read_bytes()
    other = pulled("other", bar__strength=9e6)
    shutil.copy(run_case(other, tmp_path) / "run.h5", folder / "run.h5")
    with pytest.raises(CaseError, match=r"bar\.strength: is 8000000\.0 here, and 9000000\.0 there"):
        resume_case(folder, until=0.05)
    (folder / "checkpoint.npz").write_bytes(re.sub(rb'("version": ")[^"]+', version_of_equal_length, checkpoint))
    with pytest.raises(RecordError, match="is damaged: Bad CRC-32"):
        resume_case(folder, until=0.05)
    for damaged, reason in ((checkpoint[: len(checkpoint) // 2], ": File is not a zip file"), (b"0", ", no archive")):
        (folder / "checkpoint.npz").write_bytes(damaged)
        with pytest.raises(RecordError, match=f"is damaged{reason}"):
            resume_case(folder, until=0.05)


def version_of_equal_length(found: re.Match) -> bytes:
    return found[1] + b"9" * (len(found[0]) - len(found[1]))


@pytest.mark.slow
def test_a_longer_run_that_ends_before_its_first_checkpoint_is_resumed(folder, tmp_path, monkeypatch) -> None:
    class Ended(job.Checkpoints):
        """Ends the run as a kill does, without a checkpoint."""

        def observe(self, run, record) -> None:
            raise SystemExit

    with monkeypatch.context() as patch:
        patch.setattr(job, "Checkpoints", Ended)
        with pytest.raises(SystemExit):
            resume_case(folder, until=0.03)
    again = resume_case(tmp_path / "bar.partial")

    longer = run_case(pulled(run__duration=0.03), tmp_path / "longer")
    assert np.array_equal(history(again / "run.h5"), history(longer / "run.h5"))


def test_a_damaged_record_is_not_continued(folder, tmp_path) -> None:
    record = folder / "run.h5"
    sound = record.read_bytes()
    part = "snapshots/0001/velocity"
    with h5py.File(record) as file:
        place = file[part].id.get_chunk_info(0).byte_offset
    data = bytearray(sound)
    data[place + 10] ^= 1
    record.write_bytes(data)
    with h5py.File(record) as file, pytest.raises(OSError, match=r"checksum|filter"):
        file[part][()]
    with pytest.raises(RecordError, match=rf"run\.h5: is damaged in {part}"):
        resume_case(folder, until=0.03)
    record.write_bytes(sound)
    with h5py.File(record, "a") as file:
        times = file["histories/gauge/time"]
        times[...] = times[:][::-1]
    with pytest.raises(RecordError, match="do not increase"):
        resume_case(folder, until=0.03)
    assert [path.name for path in tmp_path.iterdir()] == ["bar"]


def test_a_checkpoint_of_another_version_is_refused(tmp_path, monkeypatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr("dembound.results.checkpoint.__version__", "0.0.1")
        folder = run_case(pulled(run__duration=1e-2), tmp_path)
    with pytest.raises(CaseError, match=r"is of dembound 0\.0\.1, this is"):
        resume_case(folder, until=0.05)


def test_without_a_checkpoint_the_run_is_begun_anew_from_its_record(folder, tmp_path) -> None:
    partial = folder.rename(tmp_path / "bar.partial")
    (partial / "checkpoint.npz").unlink()
    rerun = re.escape(f"; `dembound rerun {partial / 'run.h5'}` runs its case anew")
    for folder in (partial, tmp_path / "bar"):
        with pytest.raises(CaseError, match=rf"{folder.name}: has no checkpoint \(checkpoint\.npz\), .*{rerun}$"):
            resume_case(folder)
    run_case(recorded_case(partial / "run.h5"), tmp_path)
    assert (tmp_path / "bar" / "run.h5").is_file()

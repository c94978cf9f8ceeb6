"""Whatever fails during a run, its record can be read, its checkpoint continued, and earlier results remain."""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from small_cases import PULLED, small

from dembound.casefile import Case
from dembound.errors import CaseError, RecordError
from dembound.interrupts import Stopped
from dembound.results import recorder
from dembound.results.folder import LOCK, OWN
from dembound.results.reader import open_record
from dembound.running import job, resume_case, run_case
from dembound.running.recorded import recorded_case

OFTEN = {"run.duration": 0.02, "run.checkpoint": 1e-9, "output.snapshots": 3, "output.energy_interval": 4e-3}
"""Changes of a bar: a longer run, with a checkpoint after every block of steps."""


def pulled(name: str = "bar", **changes: object) -> Case:
    """That bar, with keys changed: table__key for table.key."""
    return small(PULLED, name, OFTEN | {key.replace("__", "."): value for key, value in changes.items()})


@pytest.fixture
def case(monkeypatch):
    """A case whose run returns often from the loop, and writes its record and a checkpoint each time."""
    monkeypatch.setattr(recorder, "KEPT_SECONDS", 0.0)
    return pulled()


@contextmanager
def largest_file(size: int):
    """No file can become larger than so many bytes: further writes fail, as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def history(record) -> np.ndarray:
    with open_record(record) as file:
        return file["histories/gauge/velocity"][()]


def test_a_full_disk_loses_nothing_that_was_written(case, tmp_path) -> None:
    folder = run_case(case, tmp_path / "whole")
    whole, largest = history(folder / "run.h5"), max(path.stat().st_size for path in folder.rglob("*"))
    reached = set()
    for number, size in enumerate(np.linspace(100, 0.95 * largest, 9, dtype=int)):
        results = tmp_path / str(number)
        earlier = shutil.copytree(folder, results / "bar") / "run.h5"
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
    assert len(reached) > 2  # from its beginning to its end


def test_a_folder_that_is_removed_ends_the_run_with_its_name(case, tmp_path, monkeypatch) -> None:
    def removed(*_: object) -> None:
        shutil.rmtree(tmp_path / "bar.partial")

    monkeypatch.setattr(job, "write_paraview", removed)
    with pytest.raises(FileNotFoundError) as failure:
        run_case(case, tmp_path)
    assert "bar.partial" in str(failure.value.filename)


def test_a_run_that_ends_in_its_last_files_is_resumed(case, tmp_path, monkeypatch) -> None:
    whole = history(run_case(case, tmp_path / "whole") / "run.h5")

    def ended(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(job, "write_paraview", ended)
    with pytest.raises(KeyboardInterrupt):
        run_case(case, tmp_path)
    monkeypatch.undo()
    again = resume_case(tmp_path / "bar.partial")

    assert np.array_equal(history(again / "run.h5"), whole)
    assert (again / "paraview" / "bar.pvd").is_file()
    with open_record(again / "run.h5") as one, open_record(tmp_path / "whole" / "bar" / "run.h5") as other:
        assert np.array_equal(one["energy/time"], other["energy/time"])
        assert len(one["snapshots"]) == len(other["snapshots"])


def test_files_that_no_run_has_written_are_kept(case, tmp_path) -> None:
    folder = run_case(case, tmp_path)
    (folder / "notes.txt").write_text("mine")
    (folder / "paraview" / "state.pvsm").write_text("mine")
    (folder / "paraview" / "bar_0007.vtu").write_text("old")  # of an earlier run with more snapshots
    (tmp_path / "bar.partial").mkdir()
    (tmp_path / "bar.partial" / "seen.txt").write_text("mine")
    again = run_case(case, tmp_path)

    assert again == folder
    for name in ("notes.txt", "paraview/state.pvsm", "seen.txt"):
        assert (folder / name).read_text() == "mine"
    assert not (folder / "paraview" / "bar_0007.vtu").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["bar"]


def test_a_folder_left_between_two_names_is_put_in_order(case, tmp_path) -> None:
    folder = run_case(case, tmp_path)
    for both in (True, False):  # the process had ended after, or before the new folder had its name
        left = shutil.copytree(folder, tmp_path / "bar.replaced")
        (left / f"notes{both}.txt").write_text("mine")
        if not both:
            shutil.rmtree(folder)
        run_case(case, tmp_path)
        assert (folder / f"notes{both}.txt").read_text() == "mine"
        assert [path.name for path in tmp_path.iterdir()] == ["bar"]


def test_every_file_of_a_run_is_known_as_its_own(case, tmp_path) -> None:
    folder = run_case(pulled(output__pictures=True), tmp_path)
    names = [path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()]
    assert [name for name in names if not OWN.fullmatch(name)] == []


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


@pytest.mark.parametrize("name", ["bar.partial", "bar.replaced"])
def test_a_name_cannot_be_that_of_an_unfinished_run(tmp_path, name) -> None:
    with pytest.raises(CaseError, match="is no name of a case, must not end in"):
        run_case(replace(pulled(), name=name), tmp_path)


@pytest.mark.parametrize("place", ["bar", "bar.partial"])
def test_a_link_or_a_file_is_found_before_the_run(case, tmp_path, place) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "links").mkdir()
    (tmp_path / "links" / place).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(CaseError, match="is a link"):
        run_case(case, tmp_path / "links")
    (tmp_path / "files").mkdir()
    (tmp_path / "files" / place).write_text("mine")
    with pytest.raises(CaseError, match="is a file"):
        run_case(case, tmp_path / "files")
    # a link above it may lead anywhere
    (tmp_path / "results").symlink_to(tmp_path / "elsewhere")
    assert run_case(case, tmp_path / "results").is_dir()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_run_with_a_checkpoint(case, tmp_path, monkeypatch, number) -> None:
    whole = history(run_case(case, tmp_path / "whole") / "run.h5")

    class Signalled(job.Checkpoints):
        """Is signalled in one of the blocks."""

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


def test_what_cannot_be_resumed_is_refused_with_the_reason(case, tmp_path) -> None:
    with pytest.raises(CaseError, match="nothing: there is no such folder of results"):
        resume_case(tmp_path / "nothing")
    folder = run_case(case, tmp_path)
    with pytest.raises(CaseError, match=r"is complete; --until continues it"):
        resume_case(folder)
    with pytest.raises(CaseError, match=r"--until: is 0.001 s, must be after 0.02"):
        resume_case(folder, until=0.001)

    checkpoint = (folder / "checkpoint.npz").read_bytes()
    other = pulled("other", bar__strength=9e6)
    shutil.copy(run_case(other, tmp_path) / "run.h5", folder / "run.h5")
    for until in (None, 0.001, 0.05):
        with pytest.raises(CaseError, match=r"bar\.strength: is 8000000\.0 here, and 9000000\.0 there"):
            resume_case(folder, until=until)
    (folder / "checkpoint.npz").write_bytes(re.sub(rb'("version": ")[^"]+', version_of_equal_length, checkpoint))
    with pytest.raises(RecordError, match="is damaged: Bad CRC-32"):
        resume_case(folder, until=0.05)
    for damaged, reason in ((checkpoint[: len(checkpoint) // 2], ": File is not a zip file"), (b"0", ", no archive")):
        (folder / "checkpoint.npz").write_bytes(damaged)
        with pytest.raises(RecordError, match=f"is damaged{reason}"):
            resume_case(folder, until=0.05)


def version_of_equal_length(found: re.Match) -> bytes:
    return found[1] + b"9" * (len(found[0]) - len(found[1]))


def test_a_longer_run_that_ends_before_its_first_checkpoint_is_resumed(case, tmp_path, monkeypatch) -> None:
    whole = history(run_case(pulled(run__duration=0.03), tmp_path / "whole") / "run.h5")
    folder = run_case(case, tmp_path)

    class Ended(job.Checkpoints):
        """Ends the run as a kill does, without a checkpoint."""

        def observe(self, run, record) -> None:
            raise SystemExit

    monkeypatch.setattr(job, "Checkpoints", Ended)
    with pytest.raises(SystemExit):
        resume_case(folder, until=0.03)
    monkeypatch.undo()
    again = resume_case(tmp_path / "bar.partial")

    assert np.array_equal(history(again / "run.h5"), whole)


def test_a_damaged_record_is_not_continued(case, tmp_path) -> None:
    folder = run_case(case, tmp_path)
    with h5py.File(folder / "run.h5") as file:
        place = file["snapshots/0001/velocity"].id.get_chunk_info(0).byte_offset
    data = bytearray((folder / "run.h5").read_bytes())
    data[place + 10] ^= 1
    (folder / "run.h5").write_bytes(data)
    with pytest.raises(RecordError, match=r"run\.h5: is damaged in snapshots/0001/velocity"):
        resume_case(folder, until=0.03)
    assert not (tmp_path / "bar.partial").exists()


def parts_of(record) -> list[str]:
    names: list[str] = []
    with h5py.File(record) as file:
        file.visit(names.append)
    return names


def contents(folder) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("is_complete", [True, False])
def test_a_record_that_lacks_any_part_is_not_continued(case, tmp_path, is_complete: bool) -> None:
    folder = run_case(case, tmp_path / "runs")
    if not is_complete:
        folder = folder.rename(folder.with_name("bar.partial"))
    record = folder / "run.h5"
    whole = record.read_bytes()
    for part in parts_of(record):
        with h5py.File(record, "a") as file:
            del file[part]
        before = contents(tmp_path)
        with pytest.raises(RecordError, match=r"run\.h5: cannot be continued: it lacks ") as refused:
            resume_case(folder, until=0.03)
        assert len(str(refused.value).splitlines()) == 1
        assert contents(tmp_path) == before, part
        record.write_bytes(whole)
    assert resume_case(folder, until=0.03).name == "bar"


@pytest.mark.parametrize(
    ("part", "change", "reason"),
    [
        (
            "histories/gauge/velocity",
            lambda values: values[:3],
            "it lacks .* rows in histories/gauge/velocity, it has",
        ),
        ("histories/gauge/velocity", lambda values: np.full_like(values, np.nan), "velocity has a number that is not"),
        ("energy/kinetic", lambda values: np.full_like(values, np.inf), "energy/kinetic has a number that is not"),
        ("particles/volume", lambda values: values[1:], "it lacks particles/volume as this case records it"),
    ],
)
def test_a_record_with_other_numbers_is_not_continued(case, tmp_path, part, change, reason) -> None:
    folder = run_case(case, tmp_path).rename(tmp_path / "bar.partial")
    with h5py.File(folder / "run.h5", "a") as file:
        file.attrs["complete"] = False  # its columns may then differ in length
        old, values, grows = file[part], change(file[part][()]), file[part].maxshape[0] is None
        unit = old.attrs["unit"]
        del file[part]
        shape = (None, *values.shape[1:]) if grows else None
        file.create_dataset(part, data=values, maxshape=shape).attrs["unit"] = unit
    before = contents(tmp_path)
    with pytest.raises(RecordError, match=reason):
        resume_case(folder, until=0.03)
    assert contents(tmp_path) == before


def test_a_checkpoint_of_another_version_is_refused(case, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("dembound.results.checkpoint.__version__", "0.0.1")
    folder = run_case(case, tmp_path)
    monkeypatch.undo()
    with pytest.raises(CaseError, match=r"is of dembound 0\.0\.1, this is"):
        resume_case(folder, until=0.05)


def test_without_checkpoints_nothing_is_kept(case, tmp_path) -> None:
    folder = run_case(pulled(run__checkpoint=0.0), tmp_path)
    assert not (folder / "checkpoint.npz").exists()
    assert json.loads((folder / "summary.json").read_text())["resumed"] == []


def test_without_a_checkpoint_the_run_is_begun_anew_from_its_record(case, tmp_path) -> None:
    partial = run_case(case, tmp_path).rename(tmp_path / "bar.partial")
    (partial / "checkpoint.npz").unlink()
    rerun = re.escape(f"; `dembound rerun {partial / 'run.h5'}` runs its case anew")
    for folder in (partial, tmp_path / "bar"):
        with pytest.raises(CaseError, match=rf"{folder.name}: has no checkpoint \(checkpoint\.npz\), .*{rerun}$"):
            resume_case(folder)
    run_case(recorded_case(partial / "run.h5"), tmp_path)
    assert (tmp_path / "bar" / "run.h5").is_file()

    partial.mkdir()
    (tmp_path / "bar" / "run.h5").unlink()
    (tmp_path / "bar" / "checkpoint.npz").unlink()
    with pytest.raises(CaseError, match=r"ended before it could write one$"):
        resume_case(tmp_path / "bar")


def test_a_run_is_resumed_in_its_own_folder(case, tmp_path, monkeypatch) -> None:
    partial = run_case(case, tmp_path).rename(tmp_path / "bar.partial")
    monkeypatch.chdir(partial)
    assert resume_case(Path()) == tmp_path / "bar"


def test_checksums_find_a_changed_byte(case, tmp_path) -> None:
    record = run_case(case, tmp_path) / "run.h5"
    with h5py.File(record) as file:
        place = file["histories/gauge/velocity"].id.get_chunk_info(0).byte_offset
    data = bytearray(record.read_bytes())
    data[place + 100] ^= 1
    record.write_bytes(data)
    with h5py.File(record) as file, pytest.raises(OSError, match=r"checksum|filter"):
        file["histories/gauge/velocity"][()]


@pytest.mark.parametrize("part", ["inputs", "case"])
def test_a_record_without_its_case_is_damaged(case, tmp_path, part) -> None:
    record = run_case(case, tmp_path) / "run.h5"
    with h5py.File(record, "a") as file:
        del (file if part == "inputs" else file.attrs)[part]
    with pytest.raises(RecordError, match=rf"run\.h5: is damaged: it has no {part}$"):
        recorded_case(record)

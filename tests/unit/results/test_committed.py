"""A file that changes only by commits is readable as of a commit, whatever fails and wherever the process ends."""

import errno
import io
import shutil

import h5py
import numpy as np
import pytest

from dembound.results import committed as module
from dembound.results.committed import CommittedFile, changed_file, log_of, new_file
from dembound.results.reader import open_record

ROUNDS = 24


class Disk(io.FileIO):
    """A file on a disk with so many bytes left; at its end a write does a part, the next one fails."""

    left = 0

    def write(self, data) -> int:
        view = memoryview(data).cast("B")
        if Disk.left <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        part = view[: Disk.left]
        Disk.left -= len(part)
        return super().write(part)


@pytest.fixture
def disk(monkeypatch):
    """Put all files of the module on a `Disk`."""
    monkeypatch.setattr(module.io, "FileIO", Disk)
    Disk.left = 10**9
    return Disk


def rows(total: int) -> np.ndarray:
    return np.arange(3.0 * total).reshape(total, 3)


def grow(path) -> list[int]:
    """Write a file in rounds of several datasets, with a commit each; returns the rows of every commit that succeeded.

    Appends, overwritten attributes, new groups and removed ones are what a recorder does.
    """
    done, total = [], 0
    try:
        with CommittedFile(path, "w") as store:
            file = h5py.File(store, "w")
            try:
                table = file.create_dataset("rows", shape=(0, 3), maxshape=(None, 3), dtype="f8", fletcher32=True)
                for number in range(ROUNDS):
                    count = 37 * (number % 5 + 1)
                    table.resize(total + count, axis=0)
                    table[total:] = rows(total + count)[total:]
                    total += count
                    if number % 4 == 0:
                        file.create_dataset(f"shot{number}", data=np.full((300, 3), float(number)))
                    if number % 8 == 7:
                        del file[f"shot{number - 3}"]
                    file.attrs["total"] = total
                    file.flush()
                    store.commit()
                    done.append(total)
            finally:
                file.close()
    except OSError as error:
        if (error.errno, error.filename) != (errno.ENOSPC, str(path)):
            raise
    return done


def total_of(path) -> int:
    """The rows of a file as it is found by a reader, all of them checked."""
    with open_record(path) as file:
        total = int(file.attrs["total"])
        assert np.array_equal(file["rows"], rows(total))
        for name in file:
            if name.startswith("shot"):
                assert np.all(file[name][()] == float(name.removeprefix("shot")))
    return total


def test_a_full_disk_leaves_the_last_commit(tmp_path, disk) -> None:
    path = tmp_path / "a.h5"
    done = grow(path)
    assert len(done) == ROUNDS
    assert total_of(path) == done[-1]
    assert [path.name for path in tmp_path.iterdir()] == ["a.h5"]
    with h5py.File(path) as file:  # a plain HDF5 file
        assert file.attrs["total"] == done[-1]
    needed = 10**9 - disk.left
    # some rounds are reached, others not, and the disk is full in data, in logs, and while logs are applied
    ends = set()
    for left in range(0, needed, needed // 24):
        disk.left = left
        done = grow(path)
        ends.add((len(done), log_of(path).is_file()))
        if done:
            assert total_of(path) in (done[-1], *after(done[-1]))
    assert {has_log for _, has_log in ends} == {False, True}
    assert len({count for count, _ in ends}) > ROUNDS // 2


def after(total: int) -> list[int]:
    """The rows after the next commit, whose log may be complete although its changes are not all made."""
    totals = np.cumsum([37 * (number % 5 + 1) for number in range(ROUNDS)]).tolist()
    return totals[totals.index(total) + 1 :][:1]


def test_a_process_that_ends_at_any_write_leaves_a_commit(tmp_path, monkeypatch) -> None:
    path, found, commits = tmp_path / "a.h5", [], []
    commit = CommittedFile.commit

    class Spy(io.FileIO):
        """Copies all files as they are before every write."""

        def write(self, data) -> int:
            shutil.rmtree(tmp_path / "copy", ignore_errors=True)
            (tmp_path / "copy").mkdir()
            for name in ("a.h5", "a.h5.log"):
                if (tmp_path / name).is_file():
                    shutil.copy(tmp_path / name, tmp_path / "copy" / name)
            if commits:
                found.append(total_of(tmp_path / "copy" / "a.h5"))
            return super().write(data)

    def noted(store: CommittedFile, **options) -> None:
        commit(store, **options)
        commits.append(store)

    monkeypatch.setattr(module.io, "FileIO", Spy)
    monkeypatch.setattr(CommittedFile, "commit", noted)
    grow(path)

    assert len(set(found)) == ROUNDS
    assert np.all(np.diff(found) >= 0)


def test_a_damaged_log_is_not_used(tmp_path, disk) -> None:
    path = tmp_path / "a.h5"
    grow(path)
    total = total_of(path)
    store = CommittedFile(path, "a")
    with h5py.File(store, "a") as file:
        file.attrs["total"] = 0
    store._write_log(lambda descriptor: None)
    store._file.close()
    log = log_of(path).read_bytes()
    middle = len(log) // 2
    for damaged in (log[:-1], log[:middle] + bytes([log[middle] ^ 1]) + log[middle + 1 :], b""):
        log_of(path).write_bytes(damaged)
        assert total_of(path) == total


def change_and_fail(file) -> None:
    file.attrs["total"] = 3
    file.create_dataset("large", data=np.zeros(100_000))
    raise ZeroDivisionError


def test_an_error_leaves_neither_a_new_file_nor_a_change(tmp_path) -> None:
    path = tmp_path / "a.h5"
    with pytest.raises(ZeroDivisionError), new_file(path) as file:
        file.attrs["total"] = 1 / 0
    assert not list(tmp_path.iterdir())
    grow(path)
    before = path.read_bytes()
    with pytest.raises(ZeroDivisionError), changed_file(path) as file:
        change_and_fail(file)
    assert path.read_bytes() == before

    folder = tmp_path / "gone"
    folder.mkdir()
    with CommittedFile(folder / "a.h5", "w") as store:
        with h5py.File(store, "w") as file:
            file.attrs["total"] = 1
            shutil.rmtree(folder)
        with pytest.raises(FileNotFoundError, match="gone"):  # and no crash
            store.commit()

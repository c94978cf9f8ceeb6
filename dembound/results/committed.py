"""A file for HDF5 that changes only by commits, so that a process may end, or a disk be full, at any moment.

HDF5 changes its tables in place, so a file whose writer is killed between two writes may not be readable, and a write
that fails leaves the library unable to close the file. Here writes beyond the end that the file had at the last commit
go to the file at once, where no table refers to them yet. Writes below that end are kept in RAM as pages. A commit
writes the pages to a log, renames it to ``<file>.log``, changes the file, and removes the log; so either the file is
complete, or file and log together. A failed write is kept in RAM, too, so that HDF5 can finish, and
`CommittedFile.check` reports it; the file then remains in its state at the last commit.
"""

from __future__ import annotations

import io
import os
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from dembound.files import NEW, content_of, created, opened, replacing, require_plain

if TYPE_CHECKING:
    import h5py

FORMAT = ("v110", "v110")
"""Version of the HDF5 format: the first with checksums of all metadata."""

PAGE = 4096
"""Bytes of a page, the unit of the log."""

HEADER = struct.Struct("<4sQQI")
"""Header of a log: `MAGIC`, size of the file, number of pages, CRC-32 of what follows: page numbers, then pages."""

MAGIC = b"dbl1"

LONGEST = 2**26
"""Bytes by which a log may be longer than twice its file, and by which a commit may make a file longer."""


class CommittedFile(io.RawIOBase):
    """A file that is changed only by `commit`.

    Parameters
    ----------
    path : of the file.
    mode : "w" creates it with the first commit; until then it is called ``<file>.new``. "a" completes an interrupted
    commit and continues, "r" only reads.

    Raises RecordError where there is a link or no regular file; a record is read through a link, too.

    Attributes
    ----------
    failure : the first write that failed; nothing is written after it.
    """

    def __init__(self, path: Path, mode: Literal["w", "a", "r"]) -> None:
        self.path, self.log = path, log_of(path)
        self.failure: OSError | None = None
        self._pages: dict[int, bytearray] = {}
        self._at = 0
        if mode == "w":
            require_plain(self.log)
            self._place, self._file = created(path, NEW)
        else:
            self._place, self._file = path, opened(path, "r+" if mode == "a" else "r", follow=mode == "r")
        self._size = os.fstat(self._file.fileno()).st_size
        self._kept = self._size  # at the last commit
        if mode != "w" and os.path.lexists(self.log):
            self._take_log(content_of(self.log, LONGEST + 2 * self._size))
            if mode == "a":
                self.commit()

    def seekable(self) -> bool:
        """Always."""
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a position, and return it."""
        self._at = {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self._size}[whence] + offset
        return self._at

    def tell(self) -> int:
        """The present position."""
        return self._at

    def truncate(self, size: int | None = None) -> int:
        """Change the size from the next commit on."""
        self._size = self._at if size is None else size
        return self._size

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]
        """Read from the present position on; zeros where nothing was written."""
        view = memoryview(buffer).cast("B")
        read = self._read(self._at, view)
        view[read:] = bytes(len(view) - read)
        for number, inside, outside in _pages_of(self._at, len(view)):
            if number in self._pages:
                view[outside] = self._pages[number][inside]
        self._at += len(view)
        return len(view)

    def write(self, data: bytes | memoryview) -> int:  # type: ignore[override]
        """Write at the present position; returns the number of bytes even if the disk is full, see `check`."""
        view = memoryview(data).cast("B")
        kept = -(-self._kept // PAGE) * PAGE  # the last page may be in the log as a whole
        below = min(len(view), max(0, kept - self._at)) if self.failure is None else len(view)
        self._keep(self._at, view[:below])
        try:
            self._file.seek(self._at + below)
            _write_all(self._file, view[below:])
        except OSError as error:
            self.failure = error
            self._keep(self._at + below, view[below:])
        self._at += len(view)
        self._size = max(self._size, self._at)
        return len(view)

    def commit(self, *, durable: bool = True) -> None:
        """Make all that was written permanent; raises OSError as `check`.

        durable : wait for the disk, so that data survive a power failure.
        """
        self.check()
        wait = os.fsync if durable else _no_wait
        try:
            wait(self._file.fileno())
            if self._pages:
                self._write_log(wait)
                for number, page in self._pages.items():
                    self._file.seek(number * PAGE)
                    _write_all(self._file, memoryview(page))
            self._file.truncate(self._size)
            if self._pages:
                wait(self._file.fileno())
                self.log.unlink()
            if self._place != self.path:
                self._appear()
        except OSError as error:
            self.failure = error
            self.check()
        self._pages.clear()
        self._kept = self._size

    def check(self) -> None:
        """Raise OSError with the name of the file if a write has failed."""
        if self.failure is not None:
            raise OSError(self.failure.errno, self.failure.strerror, str(self.path)) from self.failure

    def close(self) -> None:
        """Close the file; what was written since the last commit is lost, and a file without a commit is removed."""
        if not self.closed:
            # a log that could not be applied needs all of the file
            if not self._file.closed and self._file.writable() and not self.log.is_file():
                self._file.truncate(self._kept)
            self._file.close()
            if self._place != self.path:
                self._place.unlink(missing_ok=True)
        super().close()

    def __repr__(self) -> str:
        return str(self.path)

    def _appear(self) -> None:
        """Give a new file its name, in place of an earlier one; it stays closed if that fails."""
        self._file.close()
        self.log.unlink(missing_ok=True)
        self._place.replace(self.path)
        self._place = self.path
        self._file = opened(self.path, "r+")

    def _read(self, at: int, view: memoryview) -> int:
        """Read bytes of the file at a position; returns their number, which is smaller at the end of the file."""
        if self._file.closed:
            return 0
        self._file.seek(at)
        return self._file.readinto(view)

    def _keep(self, start: int, view: memoryview) -> None:
        """Keep bytes in RAM, page by page."""
        for number, inside, outside in _pages_of(start, len(view)):
            if number not in self._pages:
                self._pages[number] = bytearray(PAGE)
                self._read(number * PAGE, memoryview(self._pages[number]))
            self._pages[number][inside] = view[outside]

    def _write_log(self, wait: Callable[[int], None]) -> None:
        """Write all pages to a log, completely or not at all; wait : function that waits for the disk, or not."""
        numbers = struct.pack(f"<{len(self._pages)}Q", *self._pages)
        body = numbers + b"".join(self._pages.values())
        with replacing(self.log) as file:
            file.write(HEADER.pack(MAGIC, self._size, len(self._pages), zlib.crc32(body)) + body)
            file.flush()
            wait(file.fileno())

    def _take_log(self, log: bytes) -> None:
        """Take the pages of a log; one that is not complete was never applied."""
        if len(log) < HEADER.size:
            return
        magic, size, count, checksum = HEADER.unpack_from(log)
        body = memoryview(log)[HEADER.size :]
        if magic != MAGIC or len(body) != count * (8 + PAGE) or zlib.crc32(body) != checksum:
            return
        numbers = struct.unpack_from(f"<{count}Q", body)
        if max(size, PAGE * max(numbers, default=0)) > LONGEST + 2 * self._size:
            return
        starts = range(8 * count, len(body), PAGE)
        self._pages = {number: bytearray(body[at : at + PAGE]) for number, at in zip(numbers, starts, strict=True)}
        self._size = size


def _no_wait(descriptor: int) -> None:
    """Does not wait for the disk."""


def _write_all(file: io.FileIO, view: memoryview) -> None:
    """Write all of some bytes to an unbuffered file."""
    while len(view) > 0:
        view = view[file.write(view) :]


def log_of(path: Path) -> Path:
    """Path of the log of a file during a commit."""
    return path.with_name(f"{path.name}.log")


@contextmanager
def new_file(path: Path) -> Iterator[h5py.File]:
    """A new HDF5 file, which appears under its name when it is complete, or not at all.

    Raises OSError, such as for a full disk, without harm to HDF5.
    """
    import h5py

    with CommittedFile(path, "w") as store:
        with h5py.File(store, "w", libver=FORMAT) as file:
            yield file
        store.commit(durable=False)


@contextmanager
def changed_file(path: Path) -> Iterator[h5py.File]:
    """An HDF5 file to be changed, created if it does not exist; it keeps its contents if there is an error.

    Raises OSError, such as for a full disk, without harm to HDF5.
    """
    import h5py

    if not os.path.lexists(path):
        with new_file(path) as file:
            yield file
        return
    with CommittedFile(path, "a") as store:
        with h5py.File(store, "a", libver=FORMAT) as file:
            yield file
        store.commit(durable=False)


def _pages_of(start: int, length: int) -> Iterator[tuple[int, slice, slice]]:
    """The pages of a range of bytes: number, the part in the page, and the same part in the range."""
    end = start + length
    for number in range(start // PAGE, -(-end // PAGE) if length > 0 else 0):
        first, last = max(start, number * PAGE), min(end, (number + 1) * PAGE)
        yield number, slice(first - number * PAGE, last - number * PAGE), slice(first - start, last - start)

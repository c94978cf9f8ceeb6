"""All files that are written, and files of results that are read back: no link is followed, and only files are opened.

A folder of results may be from somebody else, with links, pipes or huge files in it. A file is made under a name of
its own beside its place, where nothing else may be, and renamed when it is complete; a link at either name is refused,
as is one in place of a folder that dembound makes itself. Links among the folders above are the user's, and followed.
"""

from __future__ import annotations

import errno
import io
import math
import os
import shutil
import stat
import uuid
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, BinaryIO, Literal

from dembound.errors import RecordError

if TYPE_CHECKING:
    from filelock import FileLock

PART, NEW = ".part", ".new"
"""Endings of a file that is being written, and of a record until its first commit."""

MOUNT_POINT = 0xA0000003
"""Tag of the links between folders that Windows calls junctions."""

PLAIN_KINDS = "biufSU"
"""Kinds of numpy types that archives of arrays have: numbers, truth values and texts."""

MOST_ARRAYS = 1000
"""Largest number of arrays of an archive."""


def is_link(path: Path) -> bool:
    """Whether there is a link, also one that leads nowhere, or a junction of Windows."""
    try:
        found = path.lstat()
    except (OSError, ValueError):
        return False
    return stat.S_ISLNK(found.st_mode) or getattr(found, "st_reparse_tag", 0) == MOUNT_POINT


def require_plain(*paths: Path) -> None:
    """Raise RecordError if there is anything but a file at one of the paths; nothing may be there."""
    for path in paths:
        if is_link(path):
            raise RecordError([f"{path}: is a link, which is not followed here; remove it"])
        with suppress(FileNotFoundError, NotADirectoryError):
            if not stat.S_ISREG(path.lstat().st_mode):
                raise RecordError([f"{path}: is not a regular file; remove it"])


def require_writable(*paths: Path) -> None:
    """Raise RecordError as `require_plain` for files, and those from which they are renamed."""
    for path in paths:
        require_plain(path, *(path.with_name(f"{path.name}{ending}") for ending in (PART, NEW)))


def require_folder(path: Path) -> None:
    """Raise FileNotFoundError, with the name of the folder, if the folder of `path` does not exist."""
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(path.parent))


def require_no_link(*folders: Path) -> None:
    """Raise RecordError for a folder of results that is a link."""
    for path in folders:
        if is_link(path):
            raise RecordError([f"{path}: is a link, must be a folder; a link may lead to the folder above it"])


def make_folder(path: Path) -> None:
    """Make a folder of results, and those above it, unless it exists; raises RecordError as `require_no_link`."""
    require_no_link(path)
    path.mkdir(parents=True, exist_ok=True)


def below(folder: Path) -> list[Path]:
    """All files and folders in a folder, those within a folder before it; folders that are links are not entered."""
    waiting, found = [folder], list[Path]()
    while waiting:
        for path in sorted(waiting.pop().iterdir()):
            found.append(path)
            if path.is_dir() and not is_link(path):
                waiting.append(path)
    return found[::-1]


def remove(*paths: Path) -> None:
    """Remove files, if they exist; raises RecordError as `require_plain`."""
    require_plain(*paths)
    for path in paths:
        path.unlink(missing_ok=True)


def opened(path: Path, mode: Literal["r", "r+", "x+"] = "r", *, follow: bool = False) -> io.FileIO:
    """Open a file without waiting: to read, to change, or a new one (mode x+), which must not exist.

    Raises RecordError for anything but a file, and for a link unless `follow`; OSError as usual.
    """
    safe = getattr(os, "O_NONBLOCK", 0) | (0 if follow else getattr(os, "O_NOFOLLOW", 0))
    if not follow:
        require_plain(path)
    elif path.exists():
        require_plain(path.resolve())
    file = io.FileIO(path, mode, opener=lambda name, flags: os.open(name, flags | safe, 0o666))
    if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        return file
    file.close()
    raise RecordError([f"{path}: is not a regular file"])


def created(path: Path, ending: str) -> tuple[Path, io.FileIO]:
    """A new file beside `path`, open, and its path: its name with an ending.

    What a process that was killed has left under that name is removed. If another process is writing it, the new file
    has another name. Raises RecordError for a link at either place, FileNotFoundError as `require_folder`.
    """
    require_folder(path)
    part = path.with_name(f"{path.name}{ending}")
    require_plain(path, part)
    with suppress(OSError):  # Windows keeps a file that is open
        if part.exists() and not _is_held(part):
            part.unlink()
    try:
        file = opened(part, "x+")
    except FileExistsError:
        part = path.with_name(f"{path.name}.{uuid.uuid4().hex[:8]}{ending}")
        file = opened(part, "x+")
    _hold(file)
    return part, file


def _hold(file: io.FileIO) -> bool:
    """Mark an open file as being written until it is closed; whether no other process has done so."""
    with suppress(ImportError):  # Windows, which removes no file that is open
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:  # a file system without locks
            return True
    return True


def _is_held(path: Path) -> bool:
    """Whether another process is writing a file."""
    with opened(path, "r+") as file:
        return not _hold(file)


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """A new file to write into, which replaces `path` if there was no error; errors as of `created`."""
    part, raw = created(path, PART)
    try:
        with io.BufferedRandom(raw) as file:
            yield file
        part.replace(path)
    except BaseException as error:
        if isinstance(error, OSError) and error.filename is None:
            error.filename = str(path)  # errors of writing have no file name
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


@contextmanager
def replacing_by_name(path: Path) -> Iterator[Path]:
    """A path to write to, in a new folder beside `path`, for packages that take no open files; else as `replacing`."""
    require_folder(path)
    require_writable(path)
    with TemporaryDirectory(prefix=f"{path.name}.", suffix=PART, dir=path.parent) as aside:
        yield Path(aside) / path.name
        (Path(aside) / path.name).replace(path)


def write_text(path: Path, text: str) -> None:
    """Write a text in UTF-8, completely or not at all; errors as of `created`."""
    with replacing(path) as file:
        file.write(text.encode())


def copy(source: Path, target: Path, *, follow: bool = False) -> None:
    """Copy a file with its permissions, completely or not at all; errors as of `opened` and `created`."""
    with opened(source, follow=follow) as file, replacing(target) as copied:
        shutil.copyfileobj(file, copied)
        shutil.copymode(source, copied.name)


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """An empty folder that nobody else writes to, renamed to `path`, where nothing is, if there is no error."""
    with TemporaryDirectory(prefix=f"{path.name}{PART}", dir=path.parent) as aside:
        folder = Path(aside) / path.name
        folder.mkdir()
        yield folder
        folder.rename(path)


def lock_of(path: Path) -> FileLock:
    """The lock of a file that processes use in turn, not yet acquired; raises RecordError as `require_plain`."""
    from filelock import FileLock

    require_plain(path)
    return FileLock(path)


def content_of(path: Path, most: int) -> bytes:
    """The bytes of a file; raises RecordError as `opened`, and for one with more than `most` bytes."""
    with opened(path) as file:
        if os.fstat(file.fileno()).st_size > most:
            raise RecordError([f"{path}: is longer than {most:,} bytes, as no such file is"])
        return file.readall()


def arrays_of(file: BinaryIO | io.FileIO, most: int) -> dict[str, Any]:
    """The arrays of an archive (``.npz``) by name, which together declare at most `most` bytes; none is read before.

    Raises ValueError for others, and whatever damaged archives cause: `DAMAGED`.
    """
    import numpy as np

    total = 0
    file.seek(0)
    if file.read(2) != b"PK":
        raise ValueError("no archive")
    with zipfile.ZipFile(file) as archive:
        if len(archive.infolist()) > MOST_ARRAYS:
            raise ValueError(f"more than {MOST_ARRAYS} arrays")
        for each in archive.infolist():
            with archive.open(each) as member:
                version = np.lib.format.read_magic(member)
                read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
                shape, _, dtype = read(member)
            if dtype.kind not in PLAIN_KINDS or min(shape, default=0) < 0:
                raise ValueError(f"{each.filename} is no plain array")
            total += max(each.file_size, dtype.itemsize * math.prod(shape))
        if total > most:
            raise ValueError("declares more than it has")
    file.seek(0)
    with np.load(file, allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


DAMAGED = (
    *(KeyError, ValueError, TypeError, AttributeError, EOFError, NotImplementedError, MemoryError, RecursionError),
    *(zipfile.BadZipFile, zipfile.LargeZipFile, OverflowError, RuntimeError, zlib.error),
)
"""What the contents of damaged archives and texts raise."""

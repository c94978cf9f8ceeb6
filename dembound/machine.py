"""RAM, addresses, disks, cores and cache folders of this machine, and a setting by which freed arrays return RAM."""

import atexit
import ctypes
import errno
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path, PurePosixPath
from typing import NamedTuple

OWN_PAGES = 1 << 20
"""Bytes above which an array has its own pages, which go back to the system when the array is freed.

By default glibc raises this limit up to 32 MB as arrays are removed, and keeps their pages: a run of a million disks
then takes a quarter more RAM, depending on the order in which arrays come and go."""

LEAST_ADDRESSES = 600e6
"""Bytes of address space that the libraries take: with less they end in many ways, or never."""

RESERVED = 350e6
"""Bytes of addresses that a run reserves beside the RAM it uses."""

FEW_ADDRESSES = 4e9
"""Bytes of address space up to which matrices are solved with one thread, as each takes 40 MB or more."""

_MMAP_THRESHOLD = -3
"""M_MMAP_THRESHOLD of glibc's malloc.h."""


class Memory(NamedTuple):
    """RAM in bytes: total, of the machine or available to a container; free, the unused part."""

    total: float
    free: float


def give_back_at_once() -> None:
    """Let the pages of freed arrays go back to the system, in the whole process; without glibc nothing changes."""
    if sys.platform == "linux":
        choose = getattr(ctypes.CDLL(None), "mallopt", None)
        if choose is not None:
            choose(_MMAP_THRESHOLD, OWN_PAGES)


def one_thread_for_matrices() -> None:
    """Have numpy and scipy, if not yet imported, solve with one thread, unless the environment says otherwise.

    Matrices of some hundred rows gain nothing from threads, and lose much where other programs need the cores.
    """
    for library in ("OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")


def address_limit() -> float | None:
    """The limit of the address space of this process, bytes, as of ``ulimit -v``; None without one."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if limit == resource.RLIM_INFINITY else float(limit)


def memory_ran_out(error: BaseException) -> bool:
    """Whether an error is one of memory: where addresses are limited, also of a library that cannot be loaded."""
    if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
        return True
    of_library = isinstance(error, SystemError | ImportError) or (isinstance(error, OSError) and error.errno is None)
    return of_library and not isinstance(error, ModuleNotFoundError) and address_limit() is not None


def memory_here(root: Path = Path("/")) -> Memory | None:
    """The RAM this process may use; None where the system does not report it. root : of the file system.

    On Linux the smallest of that of the machine and those of its control groups, by which containers are limited; pages
    of files that the system would drop count as free. Elsewhere all RAM of the machine counts as free. A limit of the
    address space counts as RAM, less what is only reserved.
    """
    known = [*_of_linux(root / "proc/meminfo"), *_of_groups(root)] or list(_of_machine())
    known += [] if (limit := address_limit()) is None else [Memory(limit, max(limit - RESERVED, 0.0))]
    return Memory(min(m.total for m in known), min(m.free for m in known)) if known else None


def cores_here() -> int:
    """Number of cores that this process may use, which may be fewer than the machine has."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def disk_free(path: Path) -> float | None:
    """Bytes that are free on the disk of a path, which need not exist yet; None where the system does not report it."""
    for place in (path.absolute(), *path.absolute().parents):
        try:
            return float(shutil.disk_usage(place).free)
        except OSError:
            continue
    return None


def is_writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if need be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def user_cache() -> Path | None:
    """The user's folder for what can be computed again; None if it cannot be written, as without a home."""
    import platformdirs

    with suppress(RuntimeError):  # of a user without a home
        folder = Path(platformdirs.user_cache_dir("dembound"))
        return folder if is_writable(folder) else None
    return None


@cache
def private_folder() -> Path:
    """A folder among the temporary files that no other user can write: compiled code of others would run as one's own.

    It is the same one in each process of a user. Where another user has made or may write that one, it is a new one,
    deleted at the end of the process. Raises OSError if there is no place for temporary files.
    """
    user = os.getuid() if hasattr(os, "getuid") else None  # Windows has a place for each user
    folder = Path(tempfile.gettempdir()) / ("dembound" if user is None else f"dembound-{user}")
    with suppress(OSError):
        folder.mkdir(mode=0o700)
    with suppress(OSError):
        found = folder.lstat()  # a link of another user must not be followed
        is_own = user is None or (found.st_uid == user and not found.st_mode & 0o077)
        if is_own and stat.S_ISDIR(found.st_mode) and is_writable(folder):
            return folder
    fresh = Path(tempfile.mkdtemp(prefix="dembound-"))
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    return fresh


def _of_linux(path: Path) -> Iterator[Memory]:
    lines = _numbers(path, ":")
    if {"MemTotal", "MemAvailable"} <= lines.keys():
        yield Memory(1024.0 * lines["MemTotal"], 1024.0 * lines["MemAvailable"])


def _of_machine() -> Iterator[Memory]:
    try:
        total = float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):  # Windows has none of these
        return
    yield Memory(total, total)


def _of_groups(root: Path) -> Iterator[Memory]:
    """Limit and use of the control groups of this process that have a limit, in either version of the interface."""
    for group in _groups(root):
        for limit, usage, dropped in (
            ("memory.max", "memory.current", "inactive_file"),
            ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
        ):
            total, used = _number(group / limit), _number(group / usage)
            if total is not None and used is not None:
                files = _numbers(group / "memory.stat", " ").get(dropped, 0.0)
                yield Memory(total, max(total - used + files, 0.0))


def _groups(root: Path) -> set[Path]:
    """The folders of this process's control groups and of their parent groups."""
    mount, found = root / "sys/fs/cgroup", set()
    try:
        lines = (root / "proc/self/cgroup").read_text().splitlines()
    except OSError:
        return set()
    for line in lines:
        _, kinds, place = line.split(":", 2)
        if kinds in ("", "memory"):
            here = PurePosixPath(place)
            found |= {mount / kinds / str(path).lstrip("/") for path in (here, *here.parents)}
    return found


def _number(path: Path) -> float | None:
    """The number in a file; None if it has none, such as "max" for no limit."""
    try:
        return float(path.read_text())
    except (OSError, ValueError):
        return None


def _numbers(path: Path, mark: str) -> dict[str, float]:
    """The numbers in the lines of a file, by the name before a mark; none if there is no such file."""
    try:
        lines = [line.split(mark, 1) for line in path.read_text().splitlines() if mark in line]
        return {name: float(rest.split()[0]) for name, rest in lines}
    except (OSError, ValueError, IndexError):
        return {}

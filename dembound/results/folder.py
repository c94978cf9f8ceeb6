"""The folder of a run: written under another name, locked, renamed when complete; its case file."""

from __future__ import annotations

import errno
import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

from filelock import FileLock, Timeout

from dembound.casefile.model import Case
from dembound.errors import CONTROL, CaseError
from dembound.files import below, is_link, lock_of, opened, require_no_link, require_plain

PLACE, DIGEST = "source", "source_digest"
"""Attributes of a record: the case file's path relative to the parent of the folder of results, and its SHA-256."""


def file_of(case: Case) -> Path:
    """The file that a case was read from, if there is one."""
    return case.folder / f"{case.origin}.toml"


def source_of(case: Case, results: Path) -> dict[str, str]:
    """The attributes of a record in a folder within `results`; none for a case that is in no file."""
    path = file_of(case)
    if not path.is_file():
        return {}
    try:
        place = Path(os.path.relpath(path.resolve(), results.resolve())).as_posix()
    except ValueError:  # on another drive
        return {}
    return {PLACE: place, DIGEST: _digest(path)}


def recorded_source(attributes: Mapping[str, Any], results: Path) -> tuple[Path, bool] | None:
    """The case file of a record, and whether it has changed since; None if it no longer exists."""
    if PLACE not in attributes or not (path := results / str(attributes[PLACE])).is_file():
        return None
    plain = Path(os.path.normpath(path))  # another place if the folder of results is a link
    path = plain if plain.is_file() and plain.samefile(path) else path.resolve()
    return path, _digest(path) != attributes.get(DIGEST)


def _digest(path: Path) -> str:
    with opened(path, follow=True) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


PARTIAL = ".partial"
"""Ending of the folder of a run that is not complete."""

REPLACED = ".replaced"
"""Ending of a complete folder while a new one takes its place."""

LOCK = "run.lock"

OWN = re.compile(
    r"(run\.(h5|h5\.log|lock)|checkpoint\.npz|settled/[a-z._]+\.npz|summary\.json|estimate\.h5"
    r"|(scene|histories|histories_stress)\.png"
    r"|paraview/((particles|contacts|walls|joints|bar|continuum)(_\d{4,}\.vtu|\.pvd|\.vtkhdf)|cracks\.vtu|view\.py))"
    r"((\.\w{8})?\.(part|new)(/[^/]+)?)?"
)
"""The files that a run writes, by their paths in its folder; all other files are kept."""

FOLDERS = ("settled", "paraview")
"""The folders that a run makes in its folder."""


NO_NAMES = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.IGNORECASE)
"""Names that Windows reserves for devices."""


def problem_of(name: str) -> str:
    """The problem of a name for a folder of results, empty if it is valid on all systems."""
    if name in ("", ".", "..") or re.search(r"[/\\]", name):
        return "must be the name of one folder"
    if CONTROL.search(name):
        return "must have no control characters"
    if found := re.search(r'[<>:"|?*]', name):
        return f"must have no {found[0]}, which Windows does not allow"
    if name[-1] in ". ":
        return "must not end in a dot or blank, which Windows removes"
    if NO_NAMES.fullmatch(name):
        return "which Windows keeps for a device; take another one"
    return ""


def with_name(path: Path) -> Path:
    """A path that ends in the name of its folder, also for the current folder and the one above."""
    return path if path.name not in ("", "..") else path.resolve()


class Folder:
    """The folder ``results/<name>`` of a run.

    Attributes
    ----------
    final : the folder of the complete run; partial : the folder while the run is not complete.
    """

    def __init__(self, results: Path, name: str) -> None:
        self.name = name
        self.final, self.partial = results / name, results / f"{name}{PARTIAL}"
        self._old = results / f"{name}{REPLACED}"

    @classmethod
    def of(cls, path: Path) -> Self:
        """The folder of a run from the path of its complete or partial folder, which may be the current folder."""
        named = with_name(path)
        return cls(named.parent, named.name.removesuffix(PARTIAL))

    def check(self) -> None:
        """Raise CaseError where results cannot be written: at a link, a file, a folder without a run or one in use.

        Also for names that end like the partial folder of another run, or are impossible on some system. Raises
        RecordError for a link, or no file, in place of a file or folder of a run within it.
        """
        if problem := problem_of(self.name):
            raise CaseError([f"{self.name!r}: is not a valid name for results, {problem}; give another --name"])
        for ending in (PARTIAL, REPLACED):
            if self.name.endswith(ending):
                said = f"{self.name}: is not a valid name of a case, must not end in {ending}"
                raise CaseError([f"{said}; give another --name"])
        self.require_own()
        for path in (self.final, self.partial, self._old):
            if path.exists() and not path.is_dir():
                raise CaseError([f"{path}: is a file, give another --output or --name"])
        if self.final.is_dir() and any(self.final.iterdir()) and not (self.final / "run.h5").is_file():
            raise CaseError([f"{self.final}: exists and holds no run, give another --output or --name"])
        self.require_unused()

    def require_own(self) -> None:
        """Raise RecordError for a link, or what is no file, in place of a folder or file that a run writes."""
        folders = self.final, self.partial, self._old
        require_no_link(*folders, *(folder / name for folder in folders for name in FOLDERS))
        for folder in filter(Path.is_dir, folders):
            own = (each for each in below(folder) if OWN.fullmatch(each.relative_to(folder).as_posix()))
            require_plain(*(each for each in own if is_link(each) or not each.is_dir()))

    def require_unused(self) -> None:
        """Raise CaseError if a run is writing to it, RecordError if it is a link."""
        require_no_link(self.partial)
        if (self.partial / LOCK).is_file():
            self._lock().release()

    @contextmanager
    def writing(self, *, anew: bool) -> Iterator[Path]:
        """Yield the partial folder, locked, to write into; anew : without the files of an earlier run.

        An empty folder is removed afterwards. Raises CaseError as `check`.
        """
        self.check()
        self.partial.mkdir(parents=True, exist_ok=True)
        lock = self._lock()
        try:
            if anew:
                _remove_own(self.partial, but=LOCK)
            yield self.partial
        except CaseError:
            if self.partial.is_dir():
                raise
            raise FileNotFoundError(errno.ENOENT, "has been removed during the run", str(self.partial)) from None
        finally:
            for folder in (self.partial, self.final):
                (folder / LOCK).unlink(missing_ok=True)
            lock.release()
            if self.partial.is_dir() and not any(self.partial.iterdir()):
                self.partial.rmdir()

    def discard(self) -> None:
        """Remove what a run has written to the partial folder."""
        _remove_own(self.partial, but=LOCK)

    def _lock(self) -> FileLock:
        """The lock of the partial folder, acquired; raises CaseError if another run has it."""
        lock = lock_of(self.partial / LOCK)
        try:
            lock.acquire(blocking=False)
        except Timeout:
            advice = "wait for its end, or take another name"
            raise CaseError([f"{self.partial}: is being written by another run; {advice}"]) from None
        return lock

    def finish(self) -> None:
        """Replace the final folder; files in it that no run has written remain there.

        A replaced folder left by a process that ended meanwhile is also emptied.
        """
        if self.final.exists():
            if self._old.is_dir():
                self._take_replaced()
            self.final.rename(self._old)
        self.partial.rename(self.final)
        if self._old.is_dir():
            self._take_replaced()

    def _take_replaced(self) -> None:
        """Move files that no run has written from the replaced folder to the final one; CaseError if it exists."""
        _remove_own(self._old)
        _move_all(self._old, self.final)
        if self._old.is_dir():
            raise CaseError([f"{self._old}: has files that {self.final} has, too; move or remove them"])


def _remove_own(folder: Path, but: str = "") -> None:
    """Remove the files that a run has written, except one, and folders that are then empty."""
    for path in below(folder):
        name = path.relative_to(folder).as_posix()
        if path.is_dir() and not is_link(path):
            if not any(path.iterdir()):
                path.rmdir()
        elif name != but and OWN.fullmatch(name):
            path.unlink()


def _move_all(here: Path, there: Path) -> None:
    """Move all files of a folder into another one, unless there is one of that name, and remove it if it is empty.

    Folders that are links are not entered, here and there.
    """
    for path in below(here):
        target = there / path.relative_to(here)
        if path.is_dir() and not is_link(path):
            if not any(path.iterdir()):
                path.rmdir()
        elif not os.path.lexists(target) and not any(is_link(each) for each in _between(there, target)):
            target.parent.mkdir(parents=True, exist_ok=True)
            path.rename(target)
    if not any(here.iterdir()):
        here.rmdir()


def _between(folder: Path, path: Path) -> Iterator[Path]:
    """The folders within a folder that lead to a path in it."""
    yield from (each for each in path.parents if folder in each.parents)

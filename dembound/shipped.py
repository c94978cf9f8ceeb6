"""The cases that come with the package: their names, and copies of them with the files they need.

They are in the folder ``cases`` of the repository, and in ``dembound/_cases`` of a wheel. The name of a case is its
path there without ending, ``zhou2018/tunnel``. A folder of cases is a group, with its own scripts and tables.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from dembound.errors import CaseError
from dembound.files import copy as copy_file

if TYPE_CHECKING:
    from dembound.casefile import Case

PACKAGE = Path(__file__).parent

NOT_COPIED = "__pycache__"


def folder() -> Path:
    """Folder of the cases: in the installed package, or next to the package in a checkout.

    Raises CaseError if there is neither.
    """
    for place in (PACKAGE / "_cases", PACKAGE.parent / "cases"):
        if place.is_dir():
            return place
    raise CaseError(["cases: this installation has none; install dembound from a wheel or a checkout"])


def names() -> list[str]:
    """Names of all cases; those without a group come first."""
    found = [path.relative_to(folder()).with_suffix("").as_posix() for path in folder().rglob("*.toml")]
    return sorted(found, key=lambda name: ("/" in name, name))


def titles() -> dict[str, str]:
    """Name of every case -> its title, in the order of `names`."""
    return {name: tomllib.loads(_file(name).read_text(encoding="utf-8")).get("title", "") for name in names()}


def groups() -> list[str]:
    """Names of the folders that contain cases."""
    return sorted({name.rpartition("/")[0] for name in names() if "/" in name})


def copy(name: str, target: Path) -> list[Path]:
    """Copy a case and the files it reads into the folder `target`, or a group into a folder of its name there.

    Returns the copies, the case first. Raises CaseError, with nothing written, for an unknown name and for files that
    already exist.
    """
    copies = dict(_files(name))
    taken = [str(target / place) for place in copies if (target / place).exists()]
    if taken:
        others = f", together with {len(taken) - 1} more of the files to copy" if len(taken) > 1 else ""
        raise CaseError([f"{taken[0]}: exists already{others}; nothing was copied, give another folder"])
    for place, source in copies.items():
        (target / place).parent.mkdir(parents=True, exist_ok=True)
        copy_file(source, target / place, follow=True)
    return [target / place for place in copies]


def _file(name: str) -> Path:
    """The file of a case."""
    return folder() / f"{name}.toml"


def _files(name: str) -> Iterator[tuple[Path, Path]]:
    """The files of a case or a group: path of each one below the target, and its present path."""
    from dembound.casefile.messages import did_you_mean, show  # here, as listing cases takes neither of these
    from dembound.schemas import load

    if name in names():
        path = _file(name)
        for file in (path, *_read_by(load(path))):
            yield file.relative_to(path.parent), file
    elif name in groups():
        for file in sorted((folder() / name).rglob("*")):
            if file.is_file() and NOT_COPIED not in file.parts:
                yield file.relative_to(folder()), file
    else:
        alike = did_you_mean(name, [*groups(), *names()])
        raise CaseError([f"NAME: is {show(name)}, must be one of these{alike}:", *map(", ".join, _names_by_group())])


def _names_by_group() -> list[list[str]]:
    """The groups, the cases without a group, and the cases of each group."""
    return [groups(), *([name for name in names() if name.rpartition("/")[0] == group] for group in ("", *groups()))]


def _read_by(case: Case) -> Iterator[Path]:
    """The files of the waves of a case that are given by relative paths."""
    here = case.folder.resolve()
    for wave in case.wave.values():
        for path in wave.moved(here, here.parent).values():
            yield case.folder / (here.parent / path).resolve().relative_to(here)

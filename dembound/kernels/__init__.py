"""Compiled loops: arrays and floats in, arrays and floats out. None of them raises, prints or reads files."""

import hashlib
import logging
import os
import shutil
import time
from contextlib import suppress
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path

import numba

from dembound.machine import is_writable, private_folder, user_cache

LOGGER = logging.getLogger(__name__)

# Threads wait for each other at every step. Where other programs use the cores too, busy waiting makes a run many times
# slower; the variable is read when the first parallel loop starts.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")


def sources_digest(*places: Path) -> str:
    """A short hash of the contents of Python files: of single ones, and of those in folders and below."""
    files = (path for place in places for path in ([place] if place.is_file() else sorted(place.rglob("*.py"))))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]


def registered_laws() -> list[Path]:
    """The modules of other packages' laws that have functions for pairs, which become part of kernels."""
    found = []
    for entry in entry_points(group="dembound.laws"):
        package, *inner = entry.module.split(".")
        with suppress(ImportError, ValueError):
            spec = find_spec(package)  # a whole name would import the package
            roots = [] if spec is None else [Path(each) for each in spec.submodule_search_locations or []]
            places = [root.joinpath(*inner) for root in roots] if inner else []
            places += [] if spec is None or inner or spec.origin is None else [Path(spec.origin)]
            found += [each for place in places for each in (place, place.with_suffix(".py")) if each.is_file()]
    return sorted(each for each in found if b"is_pair_law" in each.read_bytes())


def prune(folder: Path, keep: str, age: float = 7 * 86400.0) -> None:
    """Remove compiled code of other states of the sources that has not been used for `age` (s).

    folder : contains a folder for each state, named by its digest; keep : the one in use, which is marked as used now.
    Errors are ignored: another process may be removing the same files, or the folder may be read-only.
    """
    with suppress(OSError):
        os.utime(folder / keep)
    with suppress(OSError):
        for old in folder.iterdir():
            named = len(old.name) == len(keep) and not set(old.name) - set("0123456789abcdef")
            if named and old.name != keep and time.time() - old.stat().st_mtime > age:
                shutil.rmtree(old, ignore_errors=True)


def kept_in(chosen: str, package: Path) -> Path:
    """The first folder that can be written, for compiled code: the chosen one, if any, else the package's; the user's.

    Without any it is a private temporary one, which is logged, and left to processes that this one begins.
    Raises OSError if that cannot be made either.
    """
    first = Path(chosen or package)
    if is_writable(first):
        return first
    if (own := user_cache()) is not None:
        return own / "compiled"
    folder = private_folder()
    LOGGER.info("compiled code is kept in %s, as %s cannot be written; NUMBA_CACHE_DIR sets a folder", folder, first)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    numba.config.reload_config()  # type: ignore[attr-defined]  # else it is read again, and set, when code is compiled
    return folder


# Numba keeps compiled code until the file of the function itself changes. Kernels also contain functions from other
# files, those of laws among them, so the code compiled from each state of all files has a separate folder.
_HERE = Path(__file__).parent
SOURCES = (_HERE, _HERE.parent / "laws", _HERE.parent / "pairwise.py")
_KEPT = kept_in(numba.config.CACHE_DIR, _HERE / "__pycache__")  # type: ignore[attr-defined]  # from the environment
_DIGEST = sources_digest(*SOURCES, *registered_laws())
prune(_KEPT, _DIGEST)
numba.config.CACHE_DIR = str(_KEPT / _DIGEST)  # type: ignore[attr-defined]

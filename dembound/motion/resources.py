"""RAM, bytes on disk and threads of a run, and an error for a run that needs more than this machine has."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import NamedTuple

import numba

from dembound.casefile.model import Case
from dembound.casefile.tables import ParaView
from dembound.errors import CaseError
from dembound.machine import Memory, memory_here

PROGRAM, PICTURES = 250e6, 285e6
"""Bytes of the interpreter, packages and compiled code during the steps of a run, and once pictures are drawn.

These two are measured, with Python 3.11 on Linux; they differ by some 10 % between versions of the packages. The first
run after an installation also compiles, which takes up to 250 MB more.
"""

DRIVEN_BYTES = 64e6
"""Largest RAM for the drives of a block; with many driven nodes blocks are shorter."""

F = 8.0
"""Bytes of a double, and of an int64."""


def motion_bytes(slots: float) -> float:
    """Bytes of a simulation: u, its successor and v (3, slots), both mobilities."""
    return (9 + 2) * F * slots


def ledger_bytes(slots: float) -> float:
    """Bytes of an energy ledger: mass and inertia, and u and v (3, slots) at the beginning of an entry."""
    return (2 + 6) * F * slots


def record_bytes(monitors: int, block: int, width: int, lines: float) -> float:
    """Bytes kept for a block of steps: twice the record (block, monitors, width), and the drives of supports.

    lines : of the support table, one for each component of a supported node. The nodes have six columns, and the drives
    (block, lines), twice, of shorter blocks where there are many.
    """
    return 2.0 * F * block * width * monitors + 6 * F * lines + 2.0 * min(DRIVEN_BYTES, F * block * lines)


def largest(stages: dict[str, float], case: Case) -> float:
    """Bytes of the program in the largest stage of a run.

    stages : bytes of the arrays of each stage before pictures.
    """
    need = PROGRAM + max(stages.values())
    return max(need, PICTURES) if case.output.pictures else need


def must_fit(need: float, key: str, things: str) -> None:
    """Raise CaseError if a run needs more RAM (bytes) than is free on this machine.

    key : of the case, which determines the number of things; things : their number in words.
    """
    here = _memory(memory_here, int(time.monotonic()))
    if here is not None and need > here.free:
        raise CaseError([f"{key}: {things} need about {in_words(need)} of memory, {has_in_words(here)}"])


@lru_cache(maxsize=1)
def _memory(read: Callable[[], Memory | None], second: int) -> Memory | None:
    """The RAM, read once a second: a search plans hundreds of scenes, and reading takes as long as planning one."""
    return read()


def has_in_words(here: Memory) -> str:
    """The RAM of this machine as text."""
    return f"this machine has {in_words(here.total)}, {in_words(here.free)} of it free"


def in_words(size: float) -> str:
    """Bytes as text, in kB, MB, GB or TB, with three digits."""
    if size < 999.5e3:
        return f"{size / 1e3:.0f} kB"
    if size < 999.5e6:
        return f"{size / 1e6:.0f} MB"
    return f"{size / 1e9:.3g} GB" if size < 999.5e9 else f"{size / 1e12:.3g} TB"


TEXT = 4.0 / 3.0
"""Bytes in a VTU file for each byte of data, as it is base64 text."""

POINT = 24.0
"""Bytes of a position, three doubles."""


class Storage(NamedTuple):
    """Bytes on disk of a scene.

    header : of data written once. snapshot : of a snapshot, in the record and in all files for ParaView.
    checkpoint : of a checkpoint, and of a settled state.
    """

    header: float
    snapshot: float
    checkpoint: float


def paraview_bytes(files: ParaView, vtu: float, vtkhdf: float) -> float:
    """Bytes of the requested files for ParaView, from the bytes of each format."""
    return vtu * (files in ("vtu", "both")) + vtkhdf * (files in ("vtkhdf", "both"))


def mesh_bytes(points: float, point_data: float, cells: float, corners: int, cell_data: float) -> float:
    """Bytes of a VTU file from numbers of points and cells, and the bytes of data for each.

    Cells have the numbers of their corners (4 bytes), where they end (4) and their types (8).
    """
    return TEXT * (points * (POINT + point_data) + cells * (4.0 * corners + 12.0 + cell_data))


PARTICLES_PER_THREAD = 40_000
"""Number of particles below which a step takes less than 0.2 ms, much of which would be the synchronisation of
threads.
"""


def thread_count_for(particles: int) -> int:
    """Number of threads for a scene with this number of particles, at most as many as are allowed."""
    return min(numba.get_num_threads(), max(1, particles // PARTICLES_PER_THREAD))


@contextmanager
def threads_for(particles: int) -> Iterator[None]:
    """Limit the threads of compiled loops inside to the number for a scene with this number of particles.

    Results do not depend on it.
    """
    allowed = numba.get_num_threads()
    numba.set_num_threads(thread_count_for(particles))
    try:
        yield
    finally:
        numba.set_num_threads(allowed)

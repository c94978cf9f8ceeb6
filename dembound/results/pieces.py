"""The fragments in a record: the number of each disk's, and their sieve curve."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dembound.results.new_record import DERIVED
from dembound.results.reader import increasing, open_record

if TYPE_CHECKING:
    import h5py

PIECE = "piece"
"""Name of the numbers of the fragments of disks, in the record and in ParaView."""


def row_of(file: h5py.File, time: float) -> int | None:
    """The row of a snapshot at a time (s) in the fragments of an open record; None where it has no such row."""
    if f"{DERIVED}/sizes" not in file:
        return None
    times = increasing(file[f"{DERIVED}/time"])
    row = int(np.searchsorted(times, time))
    return row if row < len(times) and times[row] == time else None


def pieces_at(file: h5py.File, time: float) -> np.ndarray | None:
    """Number (n,) of the fragment of each disk at a snapshot of an open record, 0 for none; None if no bond broke.

    It is one more than the number of the fragment's first disk. time : of the snapshot, s.
    """
    row = row_of(file, time)
    if row is None or f"{DERIVED}/{PIECE}" not in file:
        return None
    numbers: np.ndarray = file[f"{DERIVED}/{PIECE}"][row]
    return numbers


def sieve_at(file: h5py.File, time: float) -> tuple[np.ndarray, np.ndarray] | None:
    """The sieve curve at a snapshot of an open record: diameters (d,) m of fragments, and share (d,) not larger.

    The share is of the mass of all fragments, single disks too. None without fragments, and in a record without them.
    time : of the snapshot, s.
    """
    row = row_of(file, time)
    if row is None:
        return None
    sizes = file[f"{DERIVED}/sizes"]
    here = sizes["snapshot"][:] == row
    if not here.any():
        return None
    diameters, which = np.unique(sizes["diameter"][:][here], return_inverse=True)
    finer = np.cumsum(np.bincount(which, sizes["mass"][:][here]))
    return diameters, finer / finer[-1]


def multiples_in(file: h5py.File) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Number, snapshot and mass (kg/m), (f,) each, of all fragments of two disks or more in an open record."""
    sizes = file[f"{DERIVED}/sizes"]
    several = sizes["disks"][:] > 1
    number, snapshot, mass = (sizes[name][:][several] for name in (PIECE, "snapshot", "mass"))
    return number, snapshot, mass


def have_pieces(path: Path) -> bool:
    """Whether the record of a run has fragments of broken ground."""
    with open_record(path) as file:
        return f"{DERIVED}/{PIECE}" in file

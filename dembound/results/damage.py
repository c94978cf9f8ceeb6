"""Damage of records in words, from the errors that HDF5 reports for it, and the datasets that are damaged."""

from __future__ import annotations

import errno
import os
import re
from typing import TYPE_CHECKING

from dembound.errors import RecordError

if TYPE_CHECKING:
    import h5py

UNREADABLE = "cannot be read as a record of results"

CHECKSUM = "filter returned failure"
"""Part of HDF5's message for numbers that do not have their checksum, as no other filter is used."""


def is_of_checksum(error: Exception) -> bool:
    """Whether an error is that of numbers that do not have their checksum."""
    return CHECKSUM in str(error)


def damage_in_words(error: Exception, size: int) -> str:
    """What an error in reading a record says about it; size : of the file, bytes."""
    reason = str(error) or type(error).__name__
    if found := re.search(r"truncated file: .*stored_eof = (\d+)", reason):
        return f"is truncated, it has {size:,} of {int(found[1]):,} bytes"
    if isinstance(error, OSError) and error.errno in (errno.EAGAIN, errno.EACCES):
        is_locked = error.errno == errno.EAGAIN
        return f"{UNREADABLE}: {'another process is writing it' if is_locked else os.strerror(error.errno).lower()}"
    if "file signature not found" in reason:
        return f"{UNREADABLE}: it is {'no HDF5 file' if size else 'empty'}"
    if is_of_checksum(error):
        return "is damaged (a checksum of its numbers does not fit)"
    if "metadata checksum" in reason:
        return "is damaged (a checksum of its groups or attributes does not fit)"
    return f"{UNREADABLE}: {reason[:200]}"


def require_readable(file: h5py.File) -> None:
    """Read all numbers of a record, whose checksums are then compared.

    Raises RecordError, with the first dataset that cannot be read.
    """
    import h5py

    def read(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            try:
                item[()]
            except OSError as error:
                reason = "its checksum does not fit" if is_of_checksum(error) else str(error)
                raise RecordError([f"{file.filename}: is damaged in {name} ({reason})"]) from None

    file.visititems(read)

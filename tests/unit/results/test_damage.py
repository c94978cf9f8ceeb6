"""Damage of records is reported in words, with the dataset where it is, and with exit code 5."""

import errno

import h5py
import pytest

from dembound.errors import RecordError
from dembound.results.datasets import damage_in_words
from dembound.results.reader import open_record

VELOCITY = "snapshots/0001/velocity"


def refused(tmp_path, content: bytes) -> str:
    """The message for a record of these bytes, of which one dataset is read, without the path."""
    path = tmp_path / "run.h5"
    path.write_bytes(content)
    with pytest.raises(RecordError) as error, open_record(path) as file:
        file[VELOCITY][()]
    assert error.value.exit_code == 5
    (line,) = str(error.value).splitlines()
    return line.removeprefix(f"{path}: ")


def with_byte_changed(content: bytes, place: int) -> bytes:
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


def test_the_dataset_is_named_whose_checksum_does_not_fit(small_run, tmp_path):
    with h5py.File(small_run) as file:
        place = file[VELOCITY].id.get_chunk_info(0).byte_offset
    content = with_byte_changed(small_run.read_bytes(), place + 5)
    assert refused(tmp_path, content) == f"is damaged in {VELOCITY} (its checksum does not fit)"


def test_damaged_groups_are_distinguished_from_damaged_numbers(small_run, tmp_path):
    with h5py.File(small_run) as file:
        place = h5py.h5o.get_info(file["snapshots/0001"].id).addr
    content = with_byte_changed(small_run.read_bytes(), place + 8)
    assert refused(tmp_path, content) == "is damaged (a checksum of its groups or attributes does not fit)"


def test_a_file_that_cannot_be_read_says_why(small_run, tmp_path):
    content = small_run.read_bytes()
    for damaged, what in (
        (content[:-1], f"is truncated, it has {len(content) - 1:,} of {len(content):,} bytes"),
        (b"", "cannot be read as a record of results: it is empty"),
        (b"not a record", "cannot be read as a record of results: it is no HDF5 file"),
    ):
        assert refused(tmp_path, damaged) == what
    for number, what in ((errno.EAGAIN, "another process is writing it"), (errno.EACCES, "permission denied")):
        error = OSError(number, "Unable to synchronously open file (unable to lock file, errno = 11)")
        assert damage_in_words(error, 1000) == f"cannot be read as a record of results: {what}"

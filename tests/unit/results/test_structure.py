"""Files that are not built like a record, or are damaged, are refused by what is wrong with them."""

import errno
import json
import zlib

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError, RecordError
from dembound.results.datasets import damage_in_words
from dembound.results.reader import history_of, open_record
from dembound.results.summary import read_summary


@pytest.fixture
def record(tmp_path):
    """Writes a small file with some groups, changed by a function; returns its path."""

    def write(change=lambda file: None):
        path = tmp_path / "run.h5"
        with h5py.File(path, "w") as file:
            group = file.create_group("histories/top")
            group["time"], group["velocity"] = np.arange(4.0), np.zeros((4, 3))
            file.attrs["name"] = "bar"
            change(file)
        return path

    return write


def refusal(path) -> str:
    with pytest.raises(RecordError) as refused, open_record(path):
        pytest.fail("has been opened")
    (line,) = str(refused.value).splitlines()
    return line.removeprefix(f"{path}: is no record of dembound: ")


def test_plain_groups_are_opened_and_links_refused(record) -> None:
    with open_record(record()) as file:
        assert file["histories/top/velocity"].shape == (4, 3)
    for target in ("/", "/histories", "/histories/top/time"):
        path = record(lambda file, target=target: file["histories/top"].__setitem__("again", file[target]))
        assert refusal(path).endswith("is linked to more than once")


def large(file, **more) -> None:
    file.create_dataset("a", (2**40,), "f8", **more)


def virtual(file) -> None:
    layout = h5py.VirtualLayout((10,), "f8")
    layout[:] = h5py.VirtualSource(file.filename, "histories/top/time", (10,))
    file.create_virtual_dataset("a", layout)


def packed(file) -> None:
    # 300 MB of zeros in some 300 kB
    made = file.create_dataset("a", (40, 10**6), "f8", chunks=(1, 10**6), compression="gzip")
    zeros = zlib.compress(bytes(8 * 10**6))
    for row in range(40):
        made.id.write_direct_chunk((row, 0), zeros)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (large, "a: declares 8,796,093,022,208 bytes, and has 0"),
        (lambda file: large(file, chunks=(2**24,)), "a: has chunks of more than 67,108,864 bytes"),
        (packed, " bytes of numbers in "),
        (virtual, "a: is in another file, to which no record refers"),
        (lambda f: f.create_dataset("a", (9,), "u1", external=[("/etc/passwd", 0, 9)]), "a: is in another file, to"),
        (lambda f: f.create_dataset("a", data=np.zeros(9), compression="lzf"), "a: is compressed in a way that no"),
        (lambda f: f.create_dataset("a", data=h5py.Empty("f8")), "a: has no values"),
        (lambda f: f.create_dataset("a", (2,), h5py.vlen_dtype(float)), "a: is of a type that no record has"),
        (lambda f: f.__setitem__("a", np.dtype("f8")), "a: is neither a group nor a dataset"),
        (lambda f: f.attrs.__setitem__("size", 3.0), "attribute size: must be 2 numbers"),
        (lambda f: f.attrs.__setitem__("a", h5py.Empty("f8")), "attribute a: has no value"),
        (lambda f: f.create_dataset("histories/a/velocity", data=np.zeros((3, 4))), "must have rows of 3 numbers"),
    ],
)
def test_what_no_record_has_is_refused(record, change, why) -> None:
    assert why in refusal(record(change))


def test_summaries_that_are_none_are_refused(tmp_path) -> None:
    with pytest.raises(CaseError, match="is missing, the run is not complete"):
        read_summary(tmp_path)
    for text in ("", "{", "[]", "3", "null", "[" * 100_000, "\x00", '{"a": ' * 100_000):
        (tmp_path / "summary.json").write_text(text)
        with pytest.raises(RecordError, match=r"summary\.json: is damaged, "):
            read_summary(tmp_path)
    (tmp_path / "summary.json").write_text(json.dumps({"seconds": {"step": 1.0}, "list": [{"a": 1}]}))
    found = read_summary(tmp_path)
    assert found["seconds"]["step"] == 1.0
    for requested in (lambda: found["duration"], lambda: found["seconds"]["export"], lambda: found["list"][0]["b"]):
        with pytest.raises(RecordError, match=r"summary\.json: is damaged, or of another version .* it has no "):
            requested()


def test_times_that_do_not_increase_are_refused(record) -> None:
    for times in ([0.0, 1.0, 1.0, 2.0], [0.0, 2.0, 1.0, 3.0], [0.0, np.nan, 1.0, 2.0]):
        path = record(lambda file, times=times: file["histories/top/time"].__setitem__(..., times))
        with open_record(path) as file, pytest.raises(RecordError, match=r"histories/top/time"):
            history_of(file["histories/top"], "velocity")


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

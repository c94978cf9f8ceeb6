"""Cases and records of either kind are distinguished."""

import h5py

from dembound.kinds import kind_of_record
from dembound.kinds.bar.kind import Bars
from dembound.kinds.disks.kind import Disks


def test_a_record_is_of_a_bar_or_of_disks(spalled_run, small_run, tmp_path) -> None:
    assert isinstance(kind_of_record(spalled_run), Bars)
    assert isinstance(kind_of_record(small_run), Disks)
    with h5py.File(tmp_path / "run.h5", "w"):  # names no kind
        pass
    assert isinstance(kind_of_record(tmp_path / "run.h5"), Disks)

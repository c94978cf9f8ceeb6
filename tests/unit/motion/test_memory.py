"""A run that needs more memory than is free is refused with both numbers; amounts of memory in words."""

import pytest

from dembound.errors import CaseError
from dembound.machine import Memory
from dembound.motion import memory


def test_more_than_is_free_is_refused_with_both_numbers(monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 6e9))
    memory.must_fit(6e9, "packing.size", "7 disks")

    with pytest.raises(CaseError) as refused:
        memory.must_fit(6.1e9, "packing.size", "7 disks")
    said = "packing.size: 7 disks need about 6.1 GB of memory, this machine has 8 GB, 6 GB of it free"
    assert refused.value.problems == [said]
    monkeypatch.setattr(memory, "memory_here", lambda: None)  # unknown
    memory.must_fit(1e30, "packing.size", "7 disks")


def test_amounts_in_words() -> None:
    amounts = {
        4.2e5: "420 kB",
        12.4e6: "12 MB",
        999.4e6: "999 MB",
        999.6e6: "1 GB",
        25.27e9: "25.3 GB",
        1.52e12: "1.52 TB",
    }
    assert {size: memory.in_words(size) for size in amounts} == amounts


def test_drives_are_limited_and_records_are_not() -> None:
    # 10 monitors, 100 steps, 6 columns, twice; 5 lines of six columns, their drives twice
    assert (
        memory.total(memory.recorded(10, 100, 6, 5.0), "record") == 2 * 10 * 100 * 6 * 8 + 5 * 6 * 8 + 2 * 5 * 100 * 8
    )
    # of a million lines the drives of 100 steps would be 800 MB
    assert memory.total(memory.recorded(0, 100, 6, 1e6), "record") == 1e6 * 6 * 8 + 2 * 64e6

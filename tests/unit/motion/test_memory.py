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

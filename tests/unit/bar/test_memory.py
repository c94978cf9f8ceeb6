"""The memory of a bar is counted from its nodes and bonds."""

import pytest

from dembound.bar.scene import build_bar
from dembound.errors import CaseError
from dembound.machine import Memory
from dembound.motion import memory


def test_a_bar_too_large_is_refused_before_its_nodes_are_placed(spalling, monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(300e6, 250e6))
    said = r"^bar.spacing: 1,000,001 nodes with a horizon of 3 spacings need about \d+ MB of "
    with pytest.raises(CaseError, match=said):
        build_bar(spalling({"bar.spacing": 1e-6}))

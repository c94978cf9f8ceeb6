"""A small sweep of a rock bar, and of calibrations."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dembound.studies.sweep.members import Member, members_of, variations
from dembound.studies.sweep.perform import OUTCOMES, Task


@pytest.fixture
def rods(spalling) -> Callable[..., list[Member]]:
    """Makes members: the small rock bar under several pressures, with keys changed."""

    def make(*pressures: float, **changes: Any) -> list[Member]:
        case = spalling({"output.pictures": False, **changes}, "rod")
        members, left_out = members_of(case, variations({"load.hit.pressure": pressures}, False), "run", "impedance")
        assert not left_out
        return members

    return make


@pytest.fixture
def task(tmp_path) -> Callable[..., Task]:
    """Makes the task of a member in a folder."""

    def make(member: Member, action: str = "run", method: str = "impedance") -> Task:
        (tmp_path / OUTCOMES).mkdir(exist_ok=True)
        return Task(
            name=member.name,
            key=member.key,
            text=member.case.text,
            case_folder=Path(),
            files=member.case.files,
            action=action,
            method=method,
            current=Path.cwd(),
            folder=tmp_path,
            begun=tmp_path / "begun",
            stop=tmp_path / "stop",
        )

    return make

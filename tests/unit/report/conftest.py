"""Complete results of small runs."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from readable import drawn_quickly
from small_cases import PUSHED, SPALLING, small

from dembound import api
from dembound.report import page


@pytest.fixture(autouse=True, scope="module")
def small_pictures() -> Iterator[None]:
    """Pictures of a few dots per inch, soon drawn and packed."""
    with pytest.MonkeyPatch.context() as patch:
        drawn_quickly(patch)
        patch.setattr(page, "FRAME_DOTS", 30)
        yield


def complete(folder: Path, tables: dict, name: str, changes: dict) -> Path:
    """The record of a complete run without pictures."""
    case = small(tables, name, {"output.pictures": False, **changes})
    return api.run(case, folder, threads=1).folder / "run.h5"


@pytest.fixture(scope="session")
def pushed_runs(tmp_path_factory) -> list[Path]:
    """Two runs of disks that differ in a factor, with three snapshots; the title of the first is not to be trusted."""
    folder = tmp_path_factory.mktemp("pushed")
    title = "</pre><script>alert('a & b')</script>"
    return [
        complete(folder, PUSHED, "whole", {"output.snapshots": 3, "title": title}),
        complete(folder, PUSHED, "half", {"output.snapshots": 3, "boundary.right.beta_p": 0.5}),
    ]


@pytest.fixture(scope="session")
def spalled_results(tmp_path_factory) -> Path:
    """A run of a bar that breaks, with 12 snapshots."""
    return complete(tmp_path_factory.mktemp("bars"), SPALLING, "bar", {"output.snapshots": 12})


@pytest.fixture(scope="session")
def blind_run(tmp_path_factory) -> Path:
    """A run of disks without snapshots and monitors."""
    changes = {"output.snapshots": 0, "monitor": []}
    return complete(tmp_path_factory.mktemp("blind"), PUSHED, "blind", changes)

"""Every figure that a test of this folder makes is read."""

from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import pytest
from matplotlib.figure import Figure
from readable import problems_of

from dembound.plot import style


@pytest.fixture(autouse=True)
def read_figures(monkeypatch, request) -> Iterator[None]:
    """Read all figures of a test when it has ended, but those that were not finished, which have no title."""
    made: list[Figure] = []

    class Kept(Figure):
        def __init__(self, *args, **kwargs) -> None:
            super().__init__(*args, **kwargs)
            made.append(self)

    if "test_style" not in request.node.nodeid:  # figures without content
        monkeypatch.setattr(style, "Figure", Kept)
    yield
    problems = [line for figure in made if figure.get_suptitle() for line in problems_of(figure)]
    assert not problems, "\n".join(problems)


@pytest.fixture
def run(tmp_path) -> Path:
    """Folder for copies of records."""
    return tmp_path / "run.h5"


@pytest.fixture
def copied(run) -> Callable[[Path], h5py.File]:
    """Opens a copy of a record, which is `run`, to change it."""

    def copy(record: Path) -> h5py.File:
        run.write_bytes(record.read_bytes())
        return h5py.File(run, "r+")

    return copy

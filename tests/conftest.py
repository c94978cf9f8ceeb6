"""Fixtures for all tests."""

import gc
import os
import sys
from collections import Counter
from importlib.machinery import PathFinder
from pathlib import Path

# The installed package, which commands that tests start have too: its kernels are compiled once for both. Without one,
# or with one that is installed as a link, to this folder or to another checkout, the package here.
others = [folder for folder in sys.path if Path(folder or ".").resolve() != Path(__file__).parents[1]]
installed = PathFinder.find_spec("dembound", others)
if installed is not None and "site-packages" in Path(installed.origin or "").parts:
    sys.path[:] = others

for library in ("OPENBLAS", "OMP", "MKL"):  # before numpy: their threads would wait for each other in small matrices
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numba  # noqa: E402
import pytest  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def session_cache(tmp_path_factory):
    """A brick cache of this session's own: no test reads or fills the user's."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DEMBOUND_CACHE", str(tmp_path_factory.mktemp("bricks")))
        yield


@pytest.fixture(scope="session", autouse=True)
def one_thread():
    """Test scenes are so small that threads would mostly wait for each other."""
    numba.set_num_threads(1)


FIRST = (
    "of_bars/test_causes.py",
    "of_disks/test_law.py",
    "of_bars/test_search.py",
    "verification/test_resume.py",
    "verification/test_gauge_records.py",
    "report/test_page.py",
    "running/test_faults.py",
    "unit/test_mistakes.py",
    "unit/test_cli.py",
    "verification/test_stress_at_rest.py",
    "verification/test_hertz.py",
    "verification/test_rolling.py",
    "verification/test_damped_ground_that_breaks.py",
)
"""Files that run first: two processes begin with the first two, go on with the next two, then take one after the other.

So one compiles the kernels of bars, the other the kernels of disks. The last ones take long for few tests: among the
last files to run, one process would wait for the other.
"""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put `FIRST` first, the other files by their number of tests."""
    sizes = Counter(item.path for item in items)

    def place(item: pytest.Item) -> tuple[int, int]:
        named = (k for k, name in enumerate(FIRST) if item.path.as_posix().endswith(name))
        return next(named, len(FIRST)), -sizes[item.path]

    items.sort(key=place)


def pytest_collection_finish() -> None:
    """Search for unused objects rarely, and not among modules and tests; it would be 8 % of the time of compiling."""
    gc.freeze()
    gc.set_threshold(50_000)

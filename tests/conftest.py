"""What all tests share."""

import os
import sys
from importlib.machinery import PathFinder
from pathlib import Path

# The installed package, which commands that tests start have too: its kernels are compiled once for both. Without one,
# or with one that is installed as a link to this folder, the package here.
others = [folder for folder in sys.path if Path(folder or ".").resolve() != Path(__file__).parents[1]]
if PathFinder.find_spec("dembound", others) is not None:
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

"""What all tests share."""

import os

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

"""What all tests share."""

import numba
import pytest


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

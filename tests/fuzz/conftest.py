"""Random input, the same in every run: short sweeps, and long ones with ``-m slow``."""

from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st


@pytest.fixture(scope="session")
def sweep() -> Callable[[int], settings]:
    """Makes settings for a number of examples of a test."""

    def examples(count: int) -> settings:
        return settings(
            max_examples=count, derandomize=True, database=None, deadline=None, suppress_health_check=list(HealthCheck)
        )

    return examples


@pytest.fixture(scope="session")
def damaged() -> Callable[[bytes], st.SearchStrategy[bytes]]:
    """Makes bytes with one changed, some zeroed, overwritten or left out, or cut off.

    Half of the changes in the first tenth.
    """

    def of(content: bytes) -> st.SearchStrategy[bytes]:
        last = len(content) - 1
        places = st.one_of(st.integers(0, last), st.integers(0, last // 10))

        def written(at: int, new: bytes) -> bytes:
            return (content[:at] + new + content[at + len(new) :])[: len(content)]

        flip = st.builds(lambda at, by: written(at, bytes([content[at] ^ by])), places, st.integers(1, 255))
        zero = st.builds(lambda at, count: written(at, bytes(count)), places, st.integers(1, 500))
        fill = st.builds(written, places, st.binary(min_size=1, max_size=64))
        gone = st.builds(lambda at, count: content[:at] + content[at + count :], places, st.integers(1, 100))
        cut = places.map(lambda at: content[:at])
        return st.one_of(flip, flip, zero, fill, gone, cut).filter(lambda new: new != content)

    return of

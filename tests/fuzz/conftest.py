"""Random input, the same in every run: short sweeps, and long ones with ``-m slow``."""

from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, settings


@pytest.fixture(scope="session")
def sweep() -> Callable[[int], settings]:
    """Makes settings for so many examples of a test."""

    def examples(count: int) -> settings:
        return settings(
            max_examples=count, derandomize=True, database=None, deadline=None, suppress_health_check=list(HealthCheck)
        )

    return examples

"""How many threads a scene is worth."""

from collections.abc import Iterator
from contextlib import contextmanager

import numba

PARTICLES_PER_THREAD = 10_000
"""Below this a step takes less than 0.2 ms, and threads would spend much of it waiting for each other."""


def thread_count_for(particles: int) -> int:
    """Threads a scene of so many particles uses: at most as many as are allowed."""
    return min(numba.get_num_threads(), max(1, particles // PARTICLES_PER_THREAD))


@contextmanager
def threads_for(particles: int) -> Iterator[None]:
    """Let compiled loops inside use no more threads than a scene of so many particles is worth.

    Results do not depend on it.
    """
    allowed = numba.get_num_threads()
    numba.set_num_threads(thread_count_for(particles))
    try:
        yield
    finally:
        numba.set_num_threads(allowed)

"""Threads of compiled loops, by the size of the scene."""

from collections.abc import Iterator
from contextlib import contextmanager

import numba

PARTICLES_PER_THREAD = 40_000
"""Number of particles below which a step takes less than 0.2 ms, much of which would be the synchronisation of
threads.
"""


def thread_count_for(particles: int) -> int:
    """Number of threads for a scene with this number of particles, at most as many as are allowed."""
    return min(numba.get_num_threads(), max(1, particles // PARTICLES_PER_THREAD))


@contextmanager
def threads_for(particles: int) -> Iterator[None]:
    """Limit the threads of compiled loops inside to the number for a scene with this number of particles.

    Results do not depend on it.
    """
    allowed = numba.get_num_threads()
    numba.set_num_threads(thread_count_for(particles))
    try:
        yield
    finally:
        numba.set_num_threads(allowed)

"""How benchmarks take time."""

import time
from collections.abc import Callable

import numpy as np


def median_time(work: Callable[[], object], repeats: int) -> float:
    """Median of the seconds that some work takes; compile it before."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return float(np.median(times))

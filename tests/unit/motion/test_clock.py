"""Seconds are counted once, for the innermost section."""

import time
from itertools import count

import numba
import pytest

from dembound.motion.clock import Clock


@pytest.fixture
def ticking(monkeypatch):
    """Lets the time go on by hand."""
    now = [100.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])

    def wait(seconds: float) -> None:
        now[0] += seconds

    return wait


def test_a_section_within_another_does_not_count_for_that_one(ticking) -> None:
    clock = Clock()
    with clock.of("run"):
        ticking(1.0)
        with clock.of("draw"):
            ticking(2.0)
        ticking(4.0)
        with clock.of("draw"):
            ticking(8.0)
    ticking(16.0)  # between sections
    with clock.of("run"):
        ticking(32.0)

    assert clock.seconds == {"run": 37.0, "draw": 10.0}


def test_numba_reports_what_it_compiles_and_only_once() -> None:
    @numba.njit
    def doubled(value):
        return 2.0 * value

    clock = Clock(now=count().__next__)  # each look at the clock is a second later
    with clock.with_compiling():
        pass
    doubled(1)  # of integers, and outside
    assert not clock.seconds
    with clock.with_compiling(), clock.of("run"):
        doubled(1.0)
    assert clock.seconds["compile"] > 0.0
    # what it has been compiled for it is not compiled for again
    before = clock.seconds["compile"]
    with clock.with_compiling(), clock.of("run"):
        doubled(2.0)
    assert clock.seconds["compile"] == before

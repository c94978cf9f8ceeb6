"""Seconds are counted once, for the innermost section."""

import time

import pytest

from dembound.motion.trackers import Clock


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

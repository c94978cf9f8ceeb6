"""Progress of runs as plain lines."""

from types import SimpleNamespace

import pytest

from dembound.cli.progress import Lines


def test_the_time_left_follows_the_pace_of_the_last_minute(monkeypatch) -> None:
    said: list[str] = []
    monkeypatch.setattr("dembound.cli.progress.err.print", said.append)
    clock = [0.0]
    lines = Lines("rock", lambda: clock[0])
    run = SimpleNamespace(
        state=SimpleNamespace(step=0), scene=SimpleNamespace(count=1000), time=0.0,
        clock=SimpleNamespace(seconds={"compile": 0.0}),
    )  # fmt: skip
    for second in range(0, 301, 10):  # 1000 steps/s, and from 100 s on 100 steps/s
        clock[0], run.state.step = float(second), 1000 * min(second, 100) + 100 * max(second - 100, 0)
        lines.running(run, 1_000_000)
    assert len(said) == 30
    assert said[9].endswith("1 M particle-steps/s, about 900 s left")
    assert said[-1].endswith("0.1 M particle-steps/s, about 8800 s left")
    middle = float(said[12].split(" left")[0].split()[-2])  # 30 s of a minute at the first pace
    assert middle == pytest.approx((1_000_000 - 103_000) / (33_000 / 60.0), rel=0.04)  # printed with two digits

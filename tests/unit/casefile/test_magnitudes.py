"""Times and stresses that are probably in another unit."""

import numpy as np
import pytest

from dembound.casefile.magnitudes import grip_stress, stress_warnings, time_warnings, waves_used
from dembound.waves import Constant, Cosine

UNITS = "; are all times in s and lengths in m?"

CONSTANT = {"type": "constant", "amplitude": 1.0}
BURST = {"type": "sine_burst", "amplitude": 1.0, "frequency": 100.0, "cycles": 2}


def doubts(case, time_step: float = 1e-5, travel: float = 0.01) -> list[str]:
    return list(time_warnings(case, time_step, travel))


def test_waves_are_used_by_sides_and_loads(bar, spalling) -> None:
    spare = {"type": "cosine", "amplitude": 1.0, "period": 1.0}
    tap = {"name": "tap", "force": [1.0, 0.0], "position": [5.0, 0.5], "wave": "tapping"}
    assert waves_used(bar({"wave.spare": spare, "wave.tapping": spare, "load": [tap]})) == {"pulse", "tapping"}
    ends = {"boundary.left": {"type": "viscous_input", "wave_p": "in"}, "wave.in": spare, "wave.spare": spare}
    assert waves_used(spalling(ends)) == {"hit", "in"}


FOOT = 0.01 * np.pi / np.arcsin(np.sqrt([0.0999, 0.1001]))
"""Periods of which the run, of 0.01 s, has 10 % of the peak: v = M sin²(πt/T), still rising at its end."""


@pytest.mark.parametrize(
    ("changes", "times", "said"),
    [
        ({}, {}, ""),
        ({"wave.pulse.period": FOOT[0]}, {}, f"reaches 10 % of its peak, which comes at {0.5 * FOOT[0]:g} s, within "),
        ({"wave.pulse.period": FOOT[1]}, {}, ""),
        # a period much longer than the way through the scene
        (
            {"wave.pulse.period": 1.01, "run.duration": 2.0},
            {},
            "has a period of 1.01 s, 101 times its way through",
        ),
        ({"wave.pulse": {**CONSTANT, "rise": 1.01}, "run.duration": 2.0}, {}, ""),  # a grip may strain a body slowly
        # or much shorter
        ({}, {"travel": 10.01}, "has a period of 0.01 s, 1/1,001 of its way through the scene, 10 s"),
        ({}, {"travel": np.nan}, ""),  # where nothing runs
        ({}, {"time_step": 1.01e-3}, "has a period of 0.01 s, 9.9 time steps of 0.00101 s"),
        ({"run.duration": 10.01}, {}, "lasts 0.01 s, and the run of 10.01 s is 1,001 times as long"),
        ({"run.duration": 10.01, "wave.pulse": BURST}, {}, ""),  # lasts as long as all its cycles
        ({"run.duration": 1e4, "wave.pulse": {**CONSTANT, "rise": 0.0}}, {}, ""),  # a sudden load is meant
    ],
)
def test_times_in_another_unit_are_doubted(bar, changes: dict, times: dict, said: str) -> None:
    found = doubts(bar(changes), **times)
    assert len(found) == bool(said)
    assert all(line.startswith(f"wave.pulse: {said}") and line.endswith(UNITS) for line in found)


def test_a_record_is_as_long_as_its_file(bar, tmp_path) -> None:
    path = tmp_path / "blow.txt"
    record = {"type": "file", "path": str(path)}
    for length, warned in ((9.99, False), (10.01, True)):
        np.savetxt(path, [[0.0, 0.0], [0.005, 1.0], [length, 0.0]])
        found = doubts(bar({"wave.pulse": {**record, "start": 1e-3}}), travel=1.0)
        assert found == warned * [f"wave.pulse: lasts 10.01 s, 1,001 times the run of 0.01 s{UNITS}"]
    # it jumps, so that its spectrum has no end; two lines hold all of it
    np.savetxt(path, [[0.0, 1.0], [0.008, 0.0]])
    assert doubts(bar({"wave.pulse": record}), time_step=0.7e-3) == []
    assert len(doubts(bar({"wave.pulse": record}), time_step=0.9e-3)) == 1


@pytest.mark.parametrize(
    ("lines", "start", "share", "early"),
    [
        ([(-0.004, 0.0), (-0.002, -2.0), (0.004, 0.0)], 0.0, "100 % of its peak at -0.002 s", "0.004"),
        ([(-0.004, 0.0), (0.004, 2.0), (0.006, 0.0)], 0.0, "50 % of its peak at 0 s", "0.004"),
        ([(-0.004, 0.0), (0.0, 0.0), (0.004, 2.0), (0.006, 0.0)], 0.0, None, ""),
        ([(-0.004, 0.04), (-0.002, -0.04), (0.0, 0.0), (0.004, 2.0), (0.006, 0.0)], 0.0, None, ""),  # noise
        ([(-0.004, 2.0), (0.01, 2.0)], 0.0, None, ""),  # steady, so that nothing is lost
    ],
)
def test_a_record_with_its_pulse_before_the_run(bar, tmp_path, lines, start: float, share, early: str) -> None:
    path = tmp_path / "blow.txt"
    np.savetxt(path, lines)
    case = bar({"wave.pulse": {"type": "file", "path": str(path), "start": start}})
    said = f"wave.pulse: reaches {share}, before the run begins at t = 0, and this part is left out; give start = "
    assert doubts(case) == ([f"{said}{early}"] if share else [])
    if share:
        assert doubts(bar({"wave.pulse": {"type": "file", "path": str(path), "start": float(early)}})) == []


def test_a_grip_strains_a_body_at_once_or_evenly() -> None:
    bodies = {"density": 2000.0, "speed": 1000.0, "length": 10.0, "duration": 1.0, "strength": 1e6}
    slow = Constant(type="constant", amplitude=1e-3)
    pulse = Cosine(type="cosine", amplitude=0.1, period=1e-3)

    # 2e9 Pa times 1 mm of 10 m beside 2e6 Pa·s/m times 1 mm/s
    assert grip_stress(slow, **bodies) == ("its stress ρc²u/L", pytest.approx(2e5, rel=1e-12))
    assert grip_stress(pulse, **bodies) == ("its stress ρcv", pytest.approx(2e5, rel=1e-12))
    # what is moved on and on bears its strength at most
    assert grip_stress(slow, **{**bodies, "duration": 100.0}) == ("its stress ρc²u/L", 1e6)


def against(stress: float) -> list[str]:
    return list(stress_warnings({"load.a": ("its pressure", 1.0), "load.b": ("its pressure", stress)}, 1e6, "s"))


def test_a_stress_far_from_the_strength() -> None:
    assert list(stress_warnings({}, 1e6, "s")) == against(101.0) == against(0.99e9) == []
    assert against(99.0) == ["load.b: its pressure is 99 Pa, 0.0099 % of s, 1 MPa: Pa and MPa?"]
    assert against(0.5) == ["load.a: its pressure is 1 Pa, 0.0001 % of s, 1 MPa: Pa and MPa?"]
    assert against(1.2e12) == ["load.b: its pressure is 1200 GPa, 1,200,000 times s, 1 MPa: Pa and MPa?"]

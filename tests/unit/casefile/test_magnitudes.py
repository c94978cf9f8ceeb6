"""Times and stresses that are probably in another unit."""

import numpy as np
import pytest

from dembound.casefile.magnitudes import FAR, grip_stress, stress_in_words, stress_warnings, time_warnings, waves_used
from dembound.waves import Constant, Cosine

UNITS = "; are all times in s and lengths in m?"

CONSTANT = {"type": "constant", "amplitude": 1.0}


def doubts(case, time_step: float = 1e-5, travel: float = 0.01) -> list[str]:
    return list(time_warnings(case, time_step, travel))


def test_waves_are_used_by_sides_and_loads(bar, spalling) -> None:
    spare = {"type": "cosine", "amplitude": 1.0, "period": 1.0}
    tap = {"name": "tap", "force": [1.0, 0.0], "position": [5.0, 0.5], "wave": "tapping"}
    assert waves_used(bar({"wave.spare": spare, "wave.tapping": spare, "load": [tap]})) == {"pulse", "tapping"}
    ends = {"boundary.left": {"type": "viscous_input", "wave_p": "in"}, "wave.in": spare, "wave.spare": spare}
    assert waves_used(spalling(ends)) == {"hit", "in"}


def test_usual_times_are_not_doubted(bar) -> None:
    assert doubts(bar()) == []


@pytest.mark.parametrize(("share", "warned"), [(0.0999, True), (0.1001, False)])
def test_a_wave_of_which_the_run_has_only_the_foot(bar, share: float, warned: bool) -> None:
    # v = M sin²(πt/T), still rising at the end of the run
    period = 0.01 * np.pi / np.arcsin(np.sqrt(share))
    said = f"wave.pulse: reaches 10 % of its peak, which comes at {0.5 * period:g} s, within the run of 0.01 s{UNITS}"
    assert doubts(bar({"wave.pulse.period": period})) == warned * [said]


def test_a_wave_that_begins_after_the_run(bar) -> None:
    said = "wave.pulse: reaches 0 % of its peak, which comes at 1.005 s, within the run of 0.01 s"
    assert doubts(bar({"wave.pulse.start": 1.0})) == [f"{said}{UNITS}"]


@pytest.mark.parametrize(("length", "warned"), [(9.99, False), (10.01, True)])
def test_a_record_much_longer_than_the_run(bar, tmp_path, length: float, warned: bool) -> None:
    path = tmp_path / "blow.txt"
    np.savetxt(path, [[0.0, 0.0], [0.005, 1.0], [length, 0.0]])
    case = bar({"wave.pulse": {"type": "file", "path": str(path), "start": 1e-3}})

    found = doubts(case, travel=1.0)
    assert found == warned * [f"wave.pulse: lasts 10.01 s, 1,001 times the run of 0.01 s{UNITS}"]


@pytest.mark.parametrize(("period", "warned"), [(0.99, False), (1.01, True)])
def test_a_period_much_longer_than_the_way_through_the_scene(bar, period: float, warned: bool) -> None:
    said = f"wave.pulse: has a period of 1.01 s, 101 times its way through the scene, 0.01 s{UNITS}"
    assert doubts(bar({"wave.pulse.period": period, "run.duration": 2.0})) == warned * [said]
    # a grip may strain a body as slowly as it likes
    assert doubts(bar({"wave.pulse": {**CONSTANT, "rise": period}, "run.duration": 2.0})) == []


@pytest.mark.parametrize(("step", "warned"), [(0.99e-3, False), (1.01e-3, True)])
def test_a_wave_of_few_steps(bar, step: float, warned: bool) -> None:
    said = f"wave.pulse: has a period of 0.01 s, 9.9 time steps of 0.00101 s{UNITS}"
    assert doubts(bar(), time_step=step) == warned * [said]


@pytest.mark.parametrize(("duration", "warned"), [(9.99, False), (10.01, True)])
def test_a_run_much_longer_than_its_waves(bar, duration: float, warned: bool) -> None:
    said = f"wave.pulse: lasts 0.01 s, and the run of 10.01 s is 1,001 times as long{UNITS}"
    assert doubts(bar({"run.duration": duration})) == warned * [said]
    # a burst lasts as long as all its cycles
    burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": 100.0, "cycles": 2}
    assert doubts(bar({"run.duration": duration, "wave.pulse": burst})) == []


@pytest.mark.parametrize(("travel", "warned"), [(9.99, False), (10.01, True)])
def test_a_period_much_shorter_than_the_way_through_the_scene(bar, travel: float, warned: bool) -> None:
    said = f"wave.pulse: has a period of 0.01 s, 1/1,001 of its way through the scene, 10 s{UNITS}"
    assert doubts(bar(), travel=travel) == warned * [said]


@pytest.mark.parametrize("rise", [0.0, 1e-9])
def test_a_sudden_load_is_meant(bar, rise: float) -> None:
    assert doubts(bar({"wave.pulse": {**CONSTANT, "rise": rise}, "run.duration": 1e4})) == []


def test_a_record_is_as_long_as_its_file(bar, tmp_path) -> None:
    # it jumps, so that its spectrum has no end; two lines hold all of it
    path = tmp_path / "jump.txt"
    np.savetxt(path, [[0.0, 1.0], [0.008, 0.0]])
    assert doubts(bar({"wave.pulse": {"type": "file", "path": str(path)}}), time_step=0.7e-3) == []
    assert len(doubts(bar({"wave.pulse": {"type": "file", "path": str(path)}}), time_step=0.9e-3)) == 1


@pytest.mark.parametrize(
    ("lines", "start", "share", "early"),
    [
        ([(-0.004, 0.0), (-0.002, -2.0), (0.004, 0.0)], 0.0, "100 % of its peak at -0.002 s", "0.004"),
        ([(-0.004, 0.0), (-0.002, 2.0), (0.004, 0.0)], 0.001, "100 % of its peak at -0.001 s", "0.004"),
        ([(-0.004, 0.0), (0.004, 2.0), (0.006, 0.0)], 0.0, "50 % of its peak at 0 s", "0.004"),
        ([(-0.004, 0.0), (-0.002, 2.0), (0.004, 0.0)], 0.004, None, ""),
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


def test_a_wave_is_doubted_once_and_only_if_it_is_used(bar) -> None:
    odd = bar({"wave.pulse.period": 10.0 * FAR, "wave.spare": {"type": "cosine", "amplitude": 1.0, "period": 1e-9}})

    assert [doubt.split(":")[0] for doubt in doubts(odd)] == ["wave.pulse"]


def test_where_nothing_runs_there_is_no_way_to_compare_with(bar) -> None:
    assert doubts(bar(), travel=np.nan) == []


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


def test_a_stress_far_below_the_strength() -> None:
    assert against(101.0) == []
    assert against(99.0) == ["load.b: its pressure is 99 Pa, 0.0099 % of s, 1 MPa: Pa and MPa?"]
    assert against(0.5) == ["load.a: its pressure is 1 Pa, 0.0001 % of s, 1 MPa: Pa and MPa?"]


def test_a_stress_far_above_the_strength() -> None:
    assert against(0.99e9) == []
    assert against(1.2e12) == ["load.b: its pressure is 1.2e+06 MPa, 1,200,000 times s, 1 MPa: Pa and MPa?"]


def test_no_stress_is_no_warning() -> None:
    assert list(stress_warnings({}, 1e6, "s")) == []


def test_stresses_are_told_in_mpa_unless_they_are_tiny() -> None:
    assert [stress_in_words(stress) for stress in (8e6, -1.23456e9, 1e4, 9999.0, -1.0, 0.0)] == [
        *("8 MPa", "-1235 MPa", "0.01 MPa", "9999 Pa", "-1 Pa", "0 Pa")
    ]

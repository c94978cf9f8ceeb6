"""Numbers and times probably in another unit, waves used for two quantities, and numbers beyond computation."""

import math

import numpy as np
import pytest
import tomli_w
from small_cases import PUSHED, SPALLING, SURROUNDED, Tables, problems_in, problems_of, small

from dembound.casefile.disks.layer import MOST_ELEMENTS
from dembound.casefile.magnitudes import grip_stress, stress_warnings, time_warnings, waves_used
from dembound.casefile.unlikely import wave_use_warnings
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.machine import Memory
from dembound.motion import memory
from dembound.running import plan
from dembound.waves import Constant, Cosine

UNITS = "; are all times in s and lengths in m?"
CONSTANT = {"type": "constant", "amplitude": 1.0}
BURST = {"type": "sine_burst", "amplitude": 1.0, "frequency": 100.0, "cycles": 2}
SPARE = {"type": "cosine", "amplitude": 1.0, "period": 1.0}


@pytest.fixture
def recorded(tmp_path):
    """Writes a record of (time, velocity) to a file, and makes its table."""

    def write(lines, **keys: float) -> Tables:
        np.savetxt(tmp_path / "blow.txt", lines)
        return {"type": "file", "path": str(tmp_path / "blow.txt"), **keys}

    return write


def doubts(case, time_step: float = 1e-5, travel: float = 0.01) -> list[str]:
    return list(time_warnings(case, time_step, travel))


def test_waves_are_used_by_sides_and_loads(bar, spalling) -> None:
    tap = {"name": "tap", "force": [1.0, 0.0], "position": [5.0, 0.5], "wave": "tapping"}
    assert waves_used(bar({"wave.spare": SPARE, "wave.tapping": SPARE, "load": [tap]})) == {"pulse", "tapping"}
    ends = {"boundary.left": {"type": "viscous_input", "wave_p": "in"}, "wave.in": SPARE, "wave.spare": SPARE}
    assert waves_used(spalling(ends)) == {"hit", "in"}
    # one that is a velocity and a factor is warned of
    assert list(wave_use_warnings(bar({"wave.tapping": SPARE, "load": [tap]}))) == []
    (said,) = wave_use_warnings(bar({"load": [tap | {"wave": "pulse"}]}))
    assert "the velocity at boundary.left.wave_p and the factor of load.tap" in said


FOOT = 0.01 * np.pi / np.arcsin(np.sqrt([0.0999, 0.1001]))
"""Periods of which the run, of 0.01 s, has 10 % of the peak: v = M sin²(πt/T), still rising at its end."""

LONG = {"run.duration": 10.01}
SLOW = {"wave.pulse.period": 1.01, "run.duration": 2.0}


@pytest.mark.parametrize(
    ("changes", "times", "said"),
    [
        ({}, {}, ""),
        ({"wave.pulse.period": FOOT[0]}, {}, f"reaches 10 % of its peak, which comes at {0.5 * FOOT[0]:g} s, within "),
        ({"wave.pulse.period": FOOT[1]}, {}, ""),
        # a period much longer than the way through the scene
        (SLOW, {}, "has a period of 1.01 s, 101 times its way through"),
        ({"wave.pulse": {**CONSTANT, "rise": 1.01}, "run.duration": 2.0}, {}, ""),  # a grip may strain a body slowly
        # or much shorter
        ({}, {"travel": 10.01}, "has a period of 0.01 s, 1/1,001 of its way through the scene, 10 s"),
        ({}, {"travel": np.nan}, ""),  # where nothing runs
        ({}, {"time_step": 1.01e-3}, "has a period of 0.01 s, 9.9 time steps of 0.00101 s"),
        (LONG, {}, "lasts 0.01 s, and the run of 10.01 s is 1,001 times as long"),
        (LONG | {"wave.pulse": BURST}, {}, ""),  # lasts as long as all its cycles
        ({"run.duration": 1e4, "wave.pulse": {**CONSTANT, "rise": 0.0}}, {}, ""),  # a sudden load is meant
    ],
)
def test_times_in_another_unit_are_doubted(bar, changes: dict, times: dict, said: str) -> None:
    found = doubts(bar(changes), **times)
    assert len(found) == bool(said)
    assert all(line.startswith(f"wave.pulse: {said}") and line.endswith(UNITS) for line in found)


def test_a_record_is_as_long_as_its_file(bar, recorded) -> None:
    for length, warned in ((9.99, False), (10.01, True)):
        wave = recorded([[0.0, 0.0], [0.005, 1.0], [length, 0.0]], start=1e-3)
        found = doubts(bar({"wave.pulse": wave}), travel=1.0)
        assert found == warned * [f"wave.pulse: lasts 10.01 s, 1,001 times the run of 0.01 s{UNITS}"]
    # it jumps, so that its spectrum has no end; two lines hold all of it
    case = bar({"wave.pulse": recorded([[0.0, 1.0], [0.008, 0.0]])})
    assert [len(doubts(case, time_step=step)) for step in (0.7e-3, 0.9e-3)] == [0, 1]


@pytest.mark.parametrize(
    ("lines", "share"),
    [
        ([(-0.004, 0.0), (-0.002, -2.0), (0.004, 0.0)], "100 % of its peak at -0.002 s"),
        ([(-0.004, 0.0), (0.004, 2.0), (0.006, 0.0)], "50 % of its peak at 0 s"),
        ([(-0.004, 0.0), (0.0, 0.0), (0.004, 2.0), (0.006, 0.0)], None),
        ([(-0.004, 0.04), (-0.002, -0.04), (0.0, 0.0), (0.004, 2.0), (0.006, 0.0)], None),  # noise
        ([(-0.004, 2.0), (0.01, 2.0)], None),  # steady, so that nothing is lost
    ],
)
def test_a_record_with_its_pulse_before_the_run(bar, recorded, lines, share) -> None:
    said = f"wave.pulse: reaches {share}, before the run begins at t = 0, and this part is left out; give start = 0.004"
    assert doubts(bar({"wave.pulse": recorded(lines, start=0.0)})) == ([said] if share else [])
    if share:
        assert doubts(bar({"wave.pulse": recorded(lines, start=0.004)})) == []


def test_a_grip_strains_a_body_at_once_or_evenly() -> None:
    bodies = {"density": 2000.0, "speed": 1000.0, "length": 10.0, "duration": 1.0, "strength": 1e6}
    slow = Constant(type="constant", amplitude=1e-3)
    pulse = Cosine(type="cosine", amplitude=0.1, period=1e-3)
    # 2e9 Pa times 1 mm of 10 m beside 2e6 Pa·s/m times 1 mm/s
    assert grip_stress(slow, **bodies) == ("its stress ρc²u/L", pytest.approx(2e5, rel=1e-12))
    assert grip_stress(pulse, **bodies) == ("its stress ρcv", pytest.approx(2e5, rel=1e-12))
    # what is moved on and on bears its strength at most
    assert grip_stress(slow, **{**bodies, "duration": 100.0}) == ("its stress ρc²u/L", 1e6)


@pytest.mark.parametrize(
    ("stress", "said"),
    [
        (101.0, ""),
        (0.99e9, ""),
        (99.0, "b: its pressure is 99 Pa, 0.0099 % of s"),
        (0.5, "a: its pressure is 1 Pa, 0.0001 % of s"),
        (1.2e12, "b: its pressure is 1200 GPa, 1,200,000 times s"),
    ],
)
def test_a_stress_far_from_the_strength(stress: float, said: str) -> None:
    found = list(stress_warnings({"load.a": ("its pressure", 1.0), "load.b": ("its pressure", stress)}, 1e6, "s"))
    assert found == [f"load.{said}, 1 MPa: Pa and MPa?"] * bool(said)
    assert list(stress_warnings({}, 1e6, "s")) == []


@pytest.mark.parametrize(
    ("velocities", "said"),
    [
        ([0.0, 1.0, 0.0], None),
        ([0.019, 1.0, -0.019], None),
        ([0.5, 1.0, 0.0], "begins at 0.5 m/s, 50 % of its peak, at 0.002 s, a jump"),
        ([0.0, 1.0, -0.25], "ends at -0.25 m/s, 25 % of its peak, at 0.004 s, a jump"),
        ([1.0, 1.0, 1.0], "begins at 1 m/s, 100 % of its peak, at 0.002 s and ends at 1 m/s"),
    ],
)
def test_a_history_that_jumps_at_its_ends_is_warned_of(bar, recorded, velocities: list, said: str | None) -> None:
    wave = recorded(np.transpose([[0.0, 0.001, 0.002], velocities]), start=0.002)
    found = list(wave_use_warnings(bar({"wave.pulse": wave, "run.duration": 0.01})))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]
    if velocities[0] == 0.0:  # an end after the run is none of it
        assert list(wave_use_warnings(bar({"wave.pulse": wave, "run.duration": 0.004}))) == []


def problems(tables: Tables) -> list[str]:
    return problems_of(tomli_w.dumps(tables))


def test_a_count_beyond_all_need_is_one_line() -> None:
    many = 2**31
    for tables, line in (
        (SURROUNDED | {"outside": {"layers": many}}, f"outside.layers: is {many}, must be at most {MOST_ELEMENTS}"),
        (PUSHED | {"output": {"snapshots": many}}, f"output.snapshots: is {many}, must be at most 10000"),
        (SPALLING | {"load": [SPALLING["load"][0] | {"nodes": many}]}, f"load[1, hit].nodes: is {many}, must be at"),
    ):
        (found,) = problems(tables)
        assert found.startswith(line)


def test_elements_for_which_there_is_no_memory_are_refused_before_they_are_made(monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 8e9))
    case = small(SURROUNDED | {"outside": {"element": 3.0, "order": 3, "margin": 1000, "layers": 1000}})
    # (4 + 2·2000)(2 + 2000) elements of nine nodes
    with pytest.raises(CaseError, match=r"outside: 72 disks and 7.2\de\+07 nodes of the continuum .* of memory"):
        plan(case)


@pytest.mark.parametrize("value", [math.inf, math.nan])
def test_a_number_that_is_not_finite_is_refused_in_the_values_of_other_keys(value: float) -> None:
    choice = {"choice": [{"name": "c", "set": {"packing.size": [10.0, 0.0]}}]}
    for tables, place in (
        ({"chart": choice}, "chart.choice[1, c].set: packing.size"),
        ({"chart": {"vary": {"run.safety": [0.5, 0.0]}}}, "chart.vary: run.safety"),
        ({"sweep": {"vary": {"run.safety": [0.5, 0.0]}}}, "sweep.vary: run.safety"),
    ):
        text = tomli_w.dumps(PUSHED | tables).replace("0.0,\n]", f"{value},\n]")
        assert problems_of(text) == [f"{place} is {value:g}, must be finite"]
    for key in ("run.duration", "packing.radius", "material.density", "wave.push.period", "chart.repeats"):
        assert problems_in(lambda key=key: with_changes(small(PUSHED), {key: value}))

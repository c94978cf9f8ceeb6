"""Gauges read from text and from records, and all that is found at once."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.spalling import Gauge, evaluate, read_free_end, read_gauge

VELOCITY = np.interp(np.arange(400), [0, 100, 140, 240, 270], [0.0, 0.0, 10.0, 4.0, 8.0])


@pytest.fixture
def text(felt, tmp_path):
    """A gauge's history in a text file, in MPa and positive in compression."""
    time, stress = felt()
    path = tmp_path / "gauge.csv"
    np.savetxt(path, np.column_stack([time, -stress]), delimiter=",")
    return path


@pytest.fixture
def record(felt, tmp_path):
    """The record of a run on a bar with two gauges, `near` at 0.6 m; `end` has velocities alone."""
    time, stress = felt()
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs.update({"name": "bar", "size": [0.99], "density": 2620.0})
        for name, place in (("near", 0.6), ("far", 0.9), ("end", 0.99)):
            group = file.create_group(f"histories/{name}")
            group.attrs["position"] = [place]
            group["time"] = time
            group["velocity"] = np.resize(VELOCITY, len(time))[:, None] * [1.0, 2.0, 3.0]
            if name != "end":
                group["stress"] = 1e6 * stress
    return path


def test_a_text_file_is_told_where_it_was_felt(text, felt):
    gauge = read_gauge(text, position=0.6, length=0.99, density=2620.0, scale=-1e6)
    time, stress = felt()
    np.testing.assert_array_equal(gauge.time, time)
    np.testing.assert_allclose(gauge.stress, 1e6 * stress, rtol=1e-15)
    assert (gauge.position, gauge.length, gauge.density) == (0.6, 0.99, 2620.0)


def test_a_record_knows_its_bar_unless_told_otherwise(record, felt):
    gauge = read_gauge(record, "near")
    np.testing.assert_array_equal(gauge.stress, 1e6 * felt()[1])
    assert (gauge.position, gauge.length, gauge.density) == (0.6, 0.99, 2620.0)
    moved = read_gauge(record, "near", position=0.5, length=1.0, density=2000.0)
    assert (moved.position, moved.length, moved.density) == (0.5, 1.0, 2000.0)


def test_the_only_gauge_needs_no_name_and_a_record_no_density(record):
    with h5py.File(record, "r+") as file:
        del file["histories/far/stress"], file.attrs["density"]
    gauge = read_gauge(record)
    assert (gauge.position, gauge.density) == (0.6, None)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "position: is not known, give it\nlength: is not known, give it"),
        ({"position": 0.6}, "length: is not known, give it"),
        ({"position": 0.99, "length": 0.99}, "position: is 0.99 m, must be between 0 and the length, 0.99 m"),
        ({"position": 0.0, "length": 0.99}, "position: is 0 m, must"),
        ({"position": np.nan, "length": 0.99}, "position: is nan m, must"),
        ({"position": 0.6, "length": 0.99, "density": 0.0}, "density: is 0 kg/m³, must be above 0"),
    ],
)
def test_gauges_beside_the_bar_are_refused(text, given, said):
    with pytest.raises(CaseError) as caught:
        read_gauge(text, **given)
    assert str(caught.value).startswith(said)


def test_files_that_hold_no_history_are_refused(tmp_path, small_run):
    short = tmp_path / "short.txt"
    short.write_text("0 1\n1 2\n")
    (tmp_path / "wide.txt").write_text("0 1 2\n1 2 3\n")
    for path, said in (
        (tmp_path / "absent.txt", "no file"),
        (tmp_path / "wide.txt", r"has 3 columns, must have two: time \(s\), stress \(Pa\)"),
        (short, "holds 2 samples, must hold three or more"),
        (small_run, "holds no history of stress"),
    ):
        with pytest.raises(CaseError, match=said):
            read_gauge(path, position=0.6, length=0.99)


def test_monitors_go_by_name(record):
    with pytest.raises(CaseError, match="monitor: is not named, must be one of far, near"):
        read_gauge(record)
    with pytest.raises(CaseError, match="monitor: is end, must be one of far, near"):
        read_gauge(record, "end")
    with pytest.raises(CaseError, match="monitor: is top, must be one of end, far, near"):
        read_free_end(record, "top")


def test_the_free_end_is_a_monitor_or_a_file(record, text, tmp_path):
    np.savetxt(tmp_path / "end.txt", np.column_stack([np.arange(400), VELOCITY]))
    np.testing.assert_array_equal(read_free_end(record, "end")[:400], VELOCITY)
    np.testing.assert_array_equal(read_free_end(text, str(tmp_path / "end.txt")), VELOCITY)


@pytest.fixture
def gauge(felt):
    """A gauge that has felt a pulse of 1 MPa that takes 40 and 80 µs."""
    time, stress = felt()
    return Gauge(time, 1e6 * stress, 0.6, 0.99, 2620.0)


def test_a_gauge_alone_tells_speed_and_attenuation(gauge):
    found = evaluate(gauge)
    # as good as the lines through its peaks are, see the tests of those: 0.04 % and 1 %
    assert found.speed.value == pytest.approx(2740.0, rel=4.2e-4)
    assert found.attenuation.value == pytest.approx(0.52, rel=0.01)
    assert (found.spall, found.pull_back) == (None, None)
    assert len(found.peaks.time) == found.speed.points == 5
    assert evaluate(gauge, count=3).speed.points == 3


def test_strengths_follow_from_where_it_spalled_and_how_its_end_moved(gauge):
    found = evaluate(gauge, spall=0.95, free_end=VELOCITY, speed=2740.0, coefficient=0.52)
    assert (found.speed.value, found.speed.points) == (2740.0, 0)
    # when the crest comes back to 0.04 m from the end, the tail there is down by 2 · 0.04/2740/80e-6 of it; the crest
    # at the gauge is e^(−0.52 · 0.6) MPa, rises in 40 and falls in 80 samples, and so is up to 1/120 above the highest
    expected = 1e6 * np.exp(-0.52 * 0.6) * 2.0 * 0.04 / 2740.0 / 80e-6
    assert found.spall.nominal == pytest.approx(expected, rel=1.0 / 120.0)
    assert found.spall.way == pytest.approx(0.39 + 0.04, rel=1e-12)
    assert found.spall.attenuated == pytest.approx(found.spall.nominal * np.exp(-0.52 * 0.43), rel=1e-12)
    assert found.pull_back == pytest.approx(0.5 * 2620.0 * 2740.0 * 6.0, rel=1e-12)


def test_without_attenuation_the_strength_stays_nominal(gauge):
    once = gauge.time < 700e-6  # one tension peak
    found = evaluate(Gauge(gauge.time[once], gauge.stress[once], 0.6, 0.99, None), spall=0.9, speed=2740.0)
    assert found.attenuation is None
    assert found.spall.attenuated is None
    assert found.spall.nominal > 0.0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"spall": 0.99}, "spall: is 0.99 m, must be between 0 and the length, 0.99 m"),
        ({"speed": 0.0}, "wave_speed: is 0 m/s, must be above 0"),
        ({"free_end": VELOCITY}, "density: is not known, give it"),
        ({"count": 1}, "peaks: 1 found in tension, must be two or more"),
    ],
)
def test_what_is_not_enough_is_refused(gauge, given, said):
    with pytest.raises(CaseError) as caught:
        evaluate(Gauge(gauge.time, gauge.stress, 0.6, 0.99, None), **given)
    assert str(caught.value) == said

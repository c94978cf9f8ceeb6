"""The command wave."""

from pathlib import Path

import numpy as np
import pytest

from dembound.exact.column import Column, Layer
from dembound.records.formats import read_record
from dembound.records.processing import processed, usual
from dembound.studies.deconvolution import ground_of_file, level_ground
from dembound.waves.file_wave import FileWave

STEP = 0.01


@pytest.fixture
def recorded(tmp_path) -> Path:
    """Two components in g, 40 s, with offsets; the second is half of the first."""
    time = STEP * np.arange(4001)
    motion = 0.2 * np.exp(-(((time - 20.0) / 2.0) ** 2)) * np.sin(2.0 * np.pi * 2.0 * (time - 20.0))
    path = tmp_path / "record.csv"
    columns = np.column_stack([time, motion + 0.01, 0.5 * motion - 0.02])
    np.savetxt(path, columns, "%.9g", ",", header="time (s),NS (g),EW (g)", comments="")
    return path


def test_a_record_becomes_waves_that_a_case_reads(dembound, recorded, tmp_path) -> None:
    answer = dembound("wave", recorded)
    assert (answer.code, answer.err) == (0, "")
    for words in ("mean of the first", "high pass at 0.1 Hz", "cosine of 2 s at both ends of the velocity"):
        assert words in answer.out  # nothing is done silently
    rows = [line.split() for line in answer.out.splitlines() if line[:2] in ("NS", "EW")]
    # its crests are 0.125 s from the middle, where the Gaussian is 0.996; samples miss them by (2π·2·0.005)²/2 < 0.2 %
    assert [row[1:3] for row in rows] == [["4001", "100"]] * 2
    assert float(rows[0][4]) == pytest.approx(0.199, abs=0.001)
    assert float(rows[0][3]) == pytest.approx(2.0 * float(rows[1][3]), rel=0.01)
    for name in ("NS", "EW"):
        path = tmp_path / f"record_velocity_{name}.csv"
        wave = FileWave(type="file", path=str(path))
        assert not list(wave.doubts("m/s", 1.0))
        assert [velocity for _, _, velocity in wave.ends()] == [0.0, 0.0]


def test_what_does_not_fit_is_refused_and_nothing_written(dembound, recorded, tmp_path) -> None:
    for options, problem in (
        (("--component", "UD"), "--component: is UD, must be one of NS, EW"),
        (("--pga", "2", "--scale", "2"), "--scale: is not allowed together with --pga"),
        (("--high-pass", "60"), "--high-pass: is 60 Hz"),
        (("--component", "NS", "-o", "record.csv"), "--output: record.csv is the record"),
    ):
        answer = dembound("wave", recorded, *options)
        assert answer.code == 2
        assert answer.err.startswith(problem)
    assert [path.name for path in tmp_path.iterdir()] == ["record.csv"]


SOIL = """
[packing]
pattern = "A"
size = [20.0, 20.0]
radius = 0.5
[material]
density = 1900.0
p_wave_speed = 300.0
fric = 0.5
[[hole]]
name = "tunnel"
type = "circle"
centre = [10.0, 10.0]
radius = 3.0
[[load]]
name = "inside"
hole = "tunnel"
pressure = 1e3
wave = "across"
[boundary.left]
type = "free_field"
[boundary.right]
type = "free_field"
[boundary.bottom]
type = "viscous_input"
half_mass = true
rock = {density = 2400.0, p_wave_speed = 1100.0, s_wave_speed = 672.0}
wave_s = "across"
wave_p = "up"
[wave.across]
type = "file"
path = "rock_NS.csv"
[wave.up]
type = "file"
path = "rock_EW.csv"
[run]
duration = 10.0
"""


@pytest.mark.slow
def test_a_surface_record_is_taken_down_in_step(dembound, recorded, tmp_path) -> None:
    """Both waves begin together: S waves in an earlier time than P waves need would come out of step."""
    (tmp_path / "soil.toml").write_text(SOIL, encoding="utf-8")
    options = ("-o", "rock.csv", "--deconvolve", "soil.toml")
    answer = dembound("wave", recorded, *options)
    assert (answer.code, answer.err.count("--as s --as p")) == (2, 1)
    answer = dembound("wave", recorded, *options, "--as", "s", "--as", "p")
    assert answer.code == 0, answer.err
    assert "waves begin 0.1 s before the record: the surface moves 0.1 s later than recorded" in answer.out
    times = STEP * np.arange(4011)
    for channel, kind in zip(read_record(recorded).channels, ("s", "p"), strict=True):
        surface = processed(channel, usual(40.0)).velocity
        wave = FileWave(type="file", path=str(tmp_path / f"rock_{channel.component}.csv"), interpolation="lines")
        ground = level_ground(ground_of_file(tmp_path / "soil.toml"), kind)
        column = Column([Layer(ground.height, 1900.0, ground.speed), Layer(1.0, 1900.0, ground.alpha * ground.speed)])
        moved = column.history(wave.velocity(times), STEP)[10:]
        assert np.abs(moved - surface).max() < 1e-3 * np.abs(surface).max()
    for wrong in (("--as", "s"), ("--as", "s", "--as", "p", "--component", "NS")):
        assert "--as: must be given" in dembound("wave", recorded, *options, *wrong).err


def test_transfer_functions_of_layers_are_drawn_and_written(dembound, recorded, tmp_path) -> None:
    """At low frequencies all ground moves alike; the first peak on rock is the ratio of impedances at most."""
    layers = "[[layer]]\nthickness = 8.0\np_wave_speed = 200.0\n[[layer]]\n"
    text = SOIL.replace('wave_p = "up"\n', "").replace("[boundary.left]", layers + "[boundary.left]", 1)
    (tmp_path / "soil.toml").write_text(text, encoding="utf-8")
    options = ("--component", "NS", "-o", "rock.csv", "--deconvolve", "soil.toml")
    answer = dembound("wave", recorded, *options, "--transfer", "ground.png")
    assert answer.code == 0, answer.err
    frequency, over_outcrop, over_within = np.genfromtxt(tmp_path / "ground.csv", delimiter=",", skip_header=1).T
    assert (frequency[0], over_outcrop[0], over_within[0]) == (0.0, 1.0, 1.0)
    softer = 2400.0 * 672.0 / (1900.0 * 200.0 / np.sqrt(2.0))
    assert 3.0 < over_outcrop.max() < softer
    assert answer.code == 0, answer.err

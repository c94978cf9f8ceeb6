"""Text files of instruments and spreadsheets, read as they are."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.gauge.gauge_io import read_free_end
from dembound.gauge.reading.signal import Reading, read_signal
from dembound.gauge.reading.units import Bridge

TIMES, VALUES = [-1e-3, -0.5e-3, 0.0, 0.5e-3], [0.001, -0.002, 0.003, -0.004]
"""Times and values in s and V."""


def lines(form, times=1.0, values=1.0):
    """The samples in a form of their numbers, in other units."""
    return [form.format(times * t, values * v) for t, v in zip(TIMES, VALUES, strict=True)]


def commas(*form):
    """The text of a file with decimal commas."""
    return [line.replace(".", ",") for line in lines(*form)]


TEKTRONIX = ["Record Length,4,Points", "Vertical Units,V,", "Horizontal Units,s,", ",,"]
FILES = {
    "tektronix": ("", [f"{left},{right}," for left, right in zip(TEKTRONIX, lines("{:.6f},{:.4f}"), strict=True)], "V"),
    "lecroy": ("LECROYWS,1,Waveform\nSegments,1,SegmentSize,4\nSegment,TrigTime\n#1,12-Mar-2015,0\nTime,Ampl\n",
               lines("{:.6e},{:.4e}"), ""),
    "keysight": ("x-axis,1\nsecond,Volt\n", lines("{:+.6e}, {:.4e}"), "V"),
    "infiniium": ("Revision:,1\nXUnits:, second\nYUnits:, Volt\nXInc:, 5e-4\nData:\n", lines("{:.6e},{:.4e}"), "V"),
    "picoscope": ("Time,Channel A\n(ms),(mV)\n\n", lines("{:.6f},{:.4f}", 1e3, 1e3), "V"),
    "tabs and commas": ("t [µs]\tU [mV]\n", commas("{:.3f}\t{:.4f}", 1e6, 1e3), "V"),
    "comments": ("# time (ms) strain\n# 1 2\n", [f"{s}  # {i}" for i, s in enumerate(lines("{:.6f} {:.4f}", 1e3))], ""),
    "microstrain": ("Time (ns);gauge 1 (µε)\n", lines("{:.1f};{:.1f}", 1e9, 1e6), "strain"),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_instruments_are_read(tmp_path, name):
    header, rows, unit = FILES[name]
    path = tmp_path / "scope.csv"
    path.write_text(header + "\n".join(rows) + "\n", encoding="utf-8")
    reading = Reading(time_unit="ms", unit="V") if name == "comments" else None  # blanks within names hide the units
    signal = read_signal(path, reading)
    np.testing.assert_allclose(signal.time, TIMES, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(signal.values, VALUES, rtol=1e-12)
    assert signal.unit == ("V" if name == "comments" else unit)


def with_header(path, header):
    """Equal times and values of 0 to 4 µs under a header."""
    samples = 1e-6 * np.arange(5.0)
    np.savetxt(path, np.column_stack([samples, samples]), header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "step", "size"),
    [
        ("time (s) velocity (mm/s)", 1.0, 1e-3),
        ("t[us] v[m/s]", 1e-6, 1.0),
        ("time (s) velocity (in/s)", 1.0, "the header has values in in/s, must be m/s, cm/s, mm/s or km/s"),
        ("time (min) velocity (m/s)", 1.0, "the header has times in min, must be s, ms, µs or ns; or --time-unit"),
    ],
)
def test_units_behind_names_that_blanks_separate_are_read_or_refused(header, step, size, tmp_path):
    path, gauge = str(with_header(tmp_path / "end.txt", header)), tmp_path / "gauge.txt"
    if isinstance(size, str):
        with pytest.raises(CaseError, match=size):
            read_free_end(gauge, path)
        return
    time, velocity = read_free_end(gauge, path)
    np.testing.assert_allclose(time, 1e-6 * step * np.arange(5.0), rtol=1e-12)
    np.testing.assert_allclose(velocity, 1e-6 * size * np.arange(5.0), rtol=1e-12)


def test_columns_go_by_name_or_number(tmp_path):
    path = tmp_path / "scope.csv"
    path.write_text("CH1 (mV),CH2 (V),Time (s),CH2\n" + "".join(f"{i},{2 * i},{3 * i},{4 * i}\n" for i in range(4)))

    def read(column, time="Time"):
        signal = read_signal(path, Reading(column, time))
        return signal.time[1], round(float(signal.values[1]), 6)

    assert read("ch1") == read("1") == (3.0, 0.001)
    assert read("2") == (3.0, 2.0)
    assert read("4", "3") == (3.0, 4.0)
    for reading, said in (
        (Reading("CH2", "3"), "--column: is CH2, is the name of several columns, give its number"),
        (Reading("5"), f"--column: is 5, must be 1 to 4 in {path}"),
        (Reading(None, "3"), f"--column: is missing, {path} has 4 columns; must be CH1, CH2, CH2"),
        (Reading("1", "3", unit="kN"), "--unit: is kN, must be Pa, kPa"),
    ):
        with pytest.raises(CaseError) as caught:
            read_signal(path, reading)
        assert str(caught.value).startswith(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("only words\n", "contains no lines of two or more numbers"),
        ("0 1\n1 2\n2 x\n3 4\n", "line 3 has no number in column 2"),
        ("0 1\n1 2\n2 3\nEND 1\n4 5\n5 6\n", "line 4 is no line of numbers like those around it"),
        ("0 1\n1 2\n2 3\nEND\n", "line 4 is no line of numbers, there must be none behind them"),
        ("0 1\n1 ∞\n2 3\n", "the value of line 2 is not finite: an overdriven channel?"),
        ("0 1\n2 2\n1 3\n", "that of line 3 does not follow the one before"),
        ("0 1\n1 1\n2 1\n", "has no signal, all values are 1"),
        ("0 1\n1 2\n2 3\n9 4\n10 5\n", "must have even times, there is a gap of 7 s at 2 s, others are 1 s"),
        ("0,000,0,10\n0,001,0,20\n0,002,0,15\n0,003,0,10\n", "has 4 columns; must be a number from 1 to 4"),
        ("a\0b", "has bytes that no text has"),
    ],
)
def test_what_is_no_signal_is_refused(tmp_path, text, said):
    path = tmp_path / "scope.txt"
    path.write_text(text)
    with pytest.raises(CaseError, match=said):
        read_signal(path)


def test_times_that_are_rounded_or_uneven_become_even(tmp_path):
    exact = 1e-6 * np.arange(1000)
    path = tmp_path / "scope.txt"
    np.savetxt(path, np.column_stack([np.round(exact, 6) * (1.0 + 1e-9), np.sin(exact)]))
    assert len(read_signal(path).notes) == 1
    rounded = np.floor(exact * 2.5e5) / 2.5e5  # three or four samples have the same time
    np.savetxt(path, np.column_stack([rounded, np.sin(exact)]))
    with pytest.raises(CaseError, match="must have increasing times, two are"):
        read_signal(path)
    half = np.round(exact / 1.5e-6) * 1.5e-6
    np.savetxt(path, np.column_stack([half, exact]))
    signal = read_signal(path)
    assert "rounded by up to 0.5 steps" in signal.notes[1]
    # the last time is rounded, too, by up to half a step of a thousand
    np.testing.assert_allclose(signal.time, exact, atol=0.75e-6)
    lost = np.delete(exact, 500)  # within half a step of even times as well
    np.savetxt(path, np.column_stack([lost, np.sin(lost)]), fmt="%.7f")
    with pytest.raises(CaseError, match="most steps are 1e-06 s; is a line missing, or there twice"):
        read_signal(path)
    uneven = exact + 0.4e-6 * np.sin(np.arange(1000.0) * 0.02) * 10.0
    np.savetxt(path, np.column_stack([uneven, 3.0 * uneven]))
    signal = read_signal(path)
    assert "uneven, resampled" in signal.notes[1]
    np.testing.assert_allclose(signal.values, 3.0 * signal.time, rtol=1e-9, atol=1e-18)
    assert np.ptp(np.diff(signal.time)) < 1e-15


def test_a_scale_makes_stresses_and_a_sign_changes_nothing_else(tmp_path):
    path = tmp_path / "scope.csv"
    path.write_text("t (s),U (mV)\n0,1\n1,2\n2,4\n")
    signal = read_signal(path, Reading(scale=-1.0))
    assert (signal.unit, signal.values.tolist()) == ("V", [-0.001, -0.002, -0.004])
    signal = read_signal(path, Reading(scale=2e6))
    assert (signal.unit, signal.values.tolist()) == ("Pa", [2000.0, 4000.0, 8000.0])
    assert "1 V is 2e+06 Pa" in signal.notes[-1]


@pytest.mark.parametrize(
    ("wiring", "poisson", "arms"),
    [("quarter", None, (1.0, 0.0, 0.0, 0.0)), ("half", None, (1.0, 0.0, 1.0, 0.0)), ("full", 0.3, (1, -0.3, 1, -0.3))],
)
def test_a_bridge_gives_back_the_strain_of_its_arms(wiring, poisson, arms):
    strain = np.array([-2e-3, 1e-3, 5e-2])
    first, second, third, fourth = (1.0 + 2.1 * share * strain for share in arms)
    # R1 and R2 in series are one branch, R4 and R3 the other: each divides the excitation
    voltage = 10.0 * 500.0 * (first / (first + second) - fourth / (fourth + third))
    bridge = Bridge(2.1, wiring, 10.0, 500.0, poisson)
    np.testing.assert_allclose(bridge.strain(voltage), strain, rtol=1e-10)


@pytest.mark.parametrize(
    ("header", "step", "unit", "size"),
    [
        ("Time/us,in/µε", 1e-6, "strain", 1e-6),
        ("t/ms,Strain/%", 1e-3, "strain", 1e-2),
        ("t/us,bridge mV/V", 1e-6, "", 1.0),  # units of their own, not quantities over units
        ("t/us,mm/m", 1e-6, "strain", 1e-3),
    ],
)
def test_units_behind_quantities_and_a_slash_are_read(header, step, unit, size, tmp_path) -> None:
    path = tmp_path / "scope.csv"
    path.write_text(f"{header}\n0,1\n1,2\n2,4\n", encoding="utf-8")
    found = read_signal(path)
    assert (found.time[1], found.unit, found.values[0]) == (pytest.approx(step), unit, pytest.approx(size))

"""Texts of numbers with home-made headers: read as they state, or refused with the option that helps."""

import re
from pathlib import Path

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.records.channel import Record
from dembound.records.formats import Reading, read_record

STEP = 0.01
VALUES = np.round(0.2 * np.sin(0.3 * np.arange(60)) * np.hanning(60), 6)
"""Accelerations, g."""

G = 9.80665


def in_lines(per: int, values: np.ndarray = VALUES, shape: str = "{:.6f}", separator: str = "  ") -> str:
    """Values, so many to a line."""
    texts = [shape.format(value) for value in values]
    return "\n".join(separator.join(texts[at : at + per]) for at in range(0, len(texts), per)) + "\n"


def timed(head: str, columns: int = 1, separator: str = ",", step: float = STEP) -> str:
    """A head, and times with columns of the values, each of half the size of the one before."""
    rows = ([f"{step * at:.2f}", *(f"{value / 2**k:.6f}" for k in range(columns))] for at, value in enumerate(VALUES))
    return head + "\n" + "\n".join(map(separator.join, rows)) + "\n"


AT2 = "PEER STRONG MOTION\nPlace, 090\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 60, DT= .0100 SEC\n"
SERIES = "Acceleration (g), dt = 0.01 s"
NUMBERED = "\n".join(f"{line} {n}" for n, line in enumerate(in_lines(4).splitlines(), start=1))
"""A deck whose lines are numbered."""

LOST = next(line for line in NUMBERED.splitlines(keepends=True) if line.endswith(" 3\n"))


def read(folder: Path, text: str, given: Reading = Reading()) -> Record:  # noqa: B008
    """The record of a text."""
    path = folder / "record.txt"
    path.write_bytes(text.encode())
    return read_record(path, given)


@pytest.mark.parametrize(
    "text",
    [
        f"{SERIES}, 60 points\n{in_lines(4)}",
        f"# Somewhere, dt = 0.01 s\n# acceleration [g]\n{in_lines(5)}",
        f"{SERIES}\n" + "\n".join(f"{line} {n}" for n, line in enumerate(in_lines(8).splitlines(), start=1)),
        timed("Time (s);a (g)", separator=";") + ";;\nEND\n",
        f"dt = 0,01 s; acceleration (g)\n{in_lines(1).replace('.', ',')}",
        "dt = 10 ms; acceleration in g\n" + in_lines(1, shape="{:.6E}").replace("E", "D"),
        "tiny, sampling: 100 Hz, acceleration: g\n" + in_lines(1, 1e-101 * VALUES, "{:.9E}").replace("E-10", "-10"),
        timed("Time/s,Acceleration/g"),
        timed("# Vs30 [m/s]: 450\n# Depth(km): 10\n# time s, acceleration in g"),
        timed("Zeit (s);Beschl. (g)", separator=";").replace(".", ","),
        timed("t ns\nsec g", separator=" "),  # "ns" is a component above a line of units, not nanoseconds
        re.sub(r"(-?\d+)\.(\d+)", r'"\1,\2"', timed("Time (s),a (g)")),
        "Delta_X\t0.01\nX_Value\ta (g)\tComment\n\t" + in_lines(1).strip().replace("\n", "\n\t"),
        AT2 + in_lines(5, shape="{:.7E}") + "*** End\n\0\0",
        (AT2 + in_lines(5)).replace("\n", "\r\r\n"),
    ],
)
def test_what_states_all_is_read(tmp_path, text):
    (channel,) = read(tmp_path, text).channels
    size = 1e-101 if "tiny" in text else 1.0
    np.testing.assert_allclose(channel.values, G * size * VALUES, atol=1e-6 * size)
    assert (channel.quantity, channel.time_step) == ("acceleration", pytest.approx(STEP))


@pytest.mark.parametrize(
    ("text", "said", "given"),
    [
        (timed("# Vs30 [m/s]: 450\n# time s, acceleration"), "no unit of the values; give it by --unit", Reading("g")),
        (timed("time (s),velocity (g)"), "has velocities in g, which measures accelerations", Reading("g")),
        (timed("Time [s],Arias intensity [m/s]"), "is no motion; name the columns by --columns", None),
        (f"{SERIES}\n{in_lines(3)}", "--columns NAME,NAME,… for columns or --series", Reading(series=True)),
        (in_lines(1), "states no time step", Reading("g", STEP)),
        (f"g, dt = 5\n{in_lines(1)}", "line 1 states a time step of 5 without a unit", None),
        (timed("time,a (g)", step=5.0), "times 5 apart without a unit", None),
        (f"{SERIES}, npts = 61\n{in_lines(1)}", "line 1 states 61 samples, there are 60; --skip 1", None),
        (f"{SERIES}, PGA = 0.5 g\n{in_lines(1)}", "a peak of 4.903 m/s², the samples have", Reading("g")),
        (f"{SERIES}, fs = 200 Hz\n{in_lines(1)}", "line 1 states 0.01 s, line 1 states 0.005 s", None),
        (f"{SERIES}\n60\n{in_lines(1)}", "line 2 may state the number of samples: --skip 2", None),
        (timed("time (s),a (g)", step=-0.01), "times that increase: -0.07 s is behind -0.06 s in line 9; if", None),
        (f"{SERIES}\n" + in_lines(1).replace(".", ",") + "0,1,2\n", "whole numbers between commas", None),
        (timed("time (s),a (m/s^2/10)"), 'states "m/s^2/10" as unit of the values, which is not known', Reading("g")),
        (f"velocity from {SERIES}\n{in_lines(1)}", "line 1 has accelerations and velocities in g;", Reading("g")),
        (f"{SERIES}\nscale factor 2.5\n{in_lines(1)}", 'line 2 has a factor, "scale factor"', Reading("g")),
        (timed("time (x10 ms),a (g)"), 'has times in "x10 ms", which is not known', None),
        (timed("Units: counts\nTime CH1 CH2", 2, " "), "line 1 has counts, which must be converted", None),
        (timed("T [s];Se [g]", separator=";"), 'column 2, "Se", is no motion', None),
        (f"{SERIES}, duration: 5 s\n{in_lines(1)}", "a length of 5 s, 60 samples, one every", Reading(time_step=STEP)),
        (re.sub("\n0.30,.*", "", timed("time (s),a (g)")), "0.31 s is behind 0.29 s, most steps are 0.01 s", None),
        (re.sub("\n0.30,.*", "\n0.30,-999", timed("time (s),a (g)")), "a has 999, far from all others", None),
        (timed("Channels: 3\ntime (s),NS (g),EW (g)", 2), "line 1 states 3 channels, there are 2", None),
        (timed("61,0.02"), "line 1 precedes times and is none: --skip 1", None),
        (f"{SERIES}\n{NUMBERED.replace(LOST, '')}", "line 3 has the number 2, the next one 4", None),
        (timed("T (s),a (g)").replace("-", ""), "column 1 may have periods, as no value is negative", None),
        (f"*DEFINE_CURVE\n1,0,1.0,9.81\n{timed('').strip()}", "line 2 has factors or offsets of the numbers", None),
        (timed("time,a (g)").replace("\n0.", "\n45000.00000"), "days of a spreadsheet? Write seconds", None),
        (timed("time,a (g)").replace("\n0.", "\n10:04:00."), "write seconds in place of dates and times of day", None),
        (AT2.replace("SEC", "SEC, DT= .02 SEC") + in_lines(5), "states time steps of .0100 and .02", None),
    ],
)  # fmt: skip
def test_what_may_be_read_in_two_ways_is_refused_with_what_helps(tmp_path, text, said, given):
    with pytest.raises(CaseError) as refused:
        read(tmp_path, text)
    (line,) = refused.value.problems
    assert said in line
    if given is not None and given.skip == 0:
        (channel,) = read(tmp_path, text, given).channels
        np.testing.assert_allclose(channel.values, G * VALUES, atol=1e-5)


def test_a_peak_that_no_channel_has_is_remarked_on(tmp_path):
    """It may be that of their resultant."""
    said = "line 1 states a peak that no channel has: PGA = 0.5 g"
    assert read(tmp_path, timed("PGA = 0.5 g\ntime (s),NS (g),EW (g)", 2)).remarks == (said,)


def test_empty_columns_are_not_closed_up(tmp_path):
    """Of several tabs between numbers, only two between all of them are one separator."""
    text = timed("time (s),NS (g),EW (g)", 2).replace(",", "\t").replace("\t", "\t\t", 4)
    with pytest.raises(CaseError, match="has"):
        read(tmp_path, re.sub("(\n[^\t]+)\t+", "\\1\t\t", text), Reading("g"))


def test_chinese_text_of_gb18030_is_read(tmp_path):
    path = tmp_path / "record.txt"
    path.write_bytes(f"时间间隔 dt = 0.01 s\n单位: gal\n加速度\n{in_lines(1)}".encode("gb18030"))
    assert read_record(path).channels[0].unit == "gal"


def test_columns_are_named_left_out_and_counted(tmp_path):
    text = timed("dt = 0.01 s", 3, separator="\t").replace("dt = 0.01 s", "measured")
    record = read(tmp_path, text, Reading("g", columns=("time", "NS", "-", "UD")))
    assert [(each.component, np.abs(each.values).max()) for each in record.channels] == [
        ("NS", pytest.approx(G * np.abs(VALUES).max())), ("UD", pytest.approx(G * np.abs(VALUES).max() / 4, rel=1e-4)),
    ]  # fmt: skip
    with pytest.raises(CaseError, match="--columns: names 2 columns"):
        read(tmp_path, text, Reading("g", columns=("time", "NS")))
    with pytest.raises(CaseError, match="--series: is not allowed together with --columns"):
        read(tmp_path, text, Reading(columns=("time", "NS"), series=True))


def test_a_units_row_and_names_of_components(tmp_path):
    """A column T is a transverse component and not a time, and a line of units below the names does not name them."""
    record = read(tmp_path, timed("Time L V T\nsec gal gal gal", 3, " "))
    assert [(each.component, each.unit) for each in record.channels] == [("L", "gal"), ("V", "gal"), ("T", "gal")]


def test_columns_that_look_like_one_series_are_refused(tmp_path):
    """Three columns of a long wave have small steps down the lines; its values in lines of three have them along."""
    wave = np.sin(0.05 * np.arange(300))
    three = np.column_stack([wave[:100], wave[100:200], wave[200:]]).ravel()
    heads = "dt = 0.01 s\nNS EW UD\ng g g\n"
    assert len(read(tmp_path, heads + in_lines(3, three)).channels) == 3
    with pytest.raises(CaseError, match="seem to be one series"):
        read(tmp_path, heads + in_lines(3, wave))

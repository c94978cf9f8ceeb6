"""Files of ground motion in the formats of several networks, of invented stations and values."""

from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import numpy as np
import pytest

from dembound import table
from dembound.errors import CaseError
from dembound.records.channel import Record
from dembound.records.formats import TYPES, read_record
from dembound.records.formats.format import Format
from dembound.records.formats.source import Source

SAMPLES = Path(__file__).parents[1] / "samples"
G = 9.80665
GAL = 0.01

# format, and of each channel: component, quantity, samples, time step, first value or None, largest size, is it stated
EXPECTED = {
    "sample.AT2": ("PEER AT2", [("045", "acceleration", 18, 0.005, 0.0, 0.25 * G, False)]),
    "sample_old.VT2": ("PEER VT2", [("135 (SAMPLE)", "velocity", 17, 0.01, 0.0, 0.125, False)]),
    "sample.DT2": ("PEER DT2", [("045", "displacement", 18, 0.005, 0.0, 0.0375, False)]),
    "sample.v1": (
        "CSMIP V1",
        [
            ("90", "acceleration", 8, 0.01, 0.0, 1.234567 * G, True),
            ("Up", "acceleration", 7, 0.005, 0.0, 0.34425 * G, True),
        ],
    ),
    "sample_film.RAW": ("CSMIP V1", [("90", "acceleration", 10, 0.005, 0.0, 0.055 * G, True)]),
    "sample.v2": (
        "CSMIP V2",
        [
            ("H1", "acceleration", 12, 0.01, 0.0, 0.7728034, True),
            ("H1", "velocity", 12, 0.01, 0.0, 0.031497, True),
            ("H1", "displacement", 12, 0.01, 0.0, 0.001654, False),  # stated with three digits
        ],
    ),
    "sample.V1c": ("COSMOS", [("360", "acceleration", 15, 0.005, 0.0, 0.105433 * G, True)]),
    "sample.V2c": ("COSMOS", [("BNZ", "velocity", 6, 0.0078125, 0.0, 0.06851512, True)]),
    "sample.EW": ("K-NET", [("E-W", "acceleration", 40, 0.05, -12085 * 3920 / 6182761 * GAL, None, True)]),
    "sample.UD1": ("KiK-net", [("U-D (borehole)", "acceleration", 40, 0.05, 10192 * 3920 / 6182761 * GAL, None, True)]),
    "sample.smc": ("USGS SMC", [("360", "acceleration", 21, 0.005, 0.0, 1.0441, True)]),
    "sample_film.smc": ("USGS SMC", [("up", "acceleration", 11, 0.00635, 0.0, None, False)]),
    "sample.csv": (
        "columns of text",
        [
            ("EW", "acceleration", 12, 0.01, 0.0, 0.5 * G, False),
            ("NS", "acceleration", 12, 0.01, 0.0, 0.25 * G, False),
            ("UD", "acceleration", 12, 0.01, 0.0, 0.125 * G, False),
        ],
    ),
    "sample_step.txt": ("columns of text", [("", "acceleration", 12, 0.005, 0.0, 0.5, False)]),
    "sample_commas.txt": ("columns of text", [("Geschwindigkeit", "velocity", 12, 0.01, 0.0, 0.25, False)]),
}


def changed(folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    """A sample with texts replaced, in another file without an ending."""
    text = (SAMPLES / name).read_bytes().decode()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "record"
    path.write_bytes(text.encode())
    return path


def refusal(path: Path, unit: str | None = None) -> str:
    """The one line of the error with which a file is refused, without its path."""
    with pytest.raises(CaseError) as refused:
        read_record(path, unit)
    (line,) = refused.value.problems
    return line.replace(f'"{path}"', "PATH")


@pytest.mark.parametrize("name", EXPECTED)
def test_every_format_is_read_in_si(tmp_path, name):
    form, channels = EXPECTED[name]
    record = read_record(changed(tmp_path, name))  # by the content: the name says nothing
    assert record.format == form
    assert len(record.channels) == len(channels)
    for channel, expected in zip(record.channels, channels, strict=True):
        component, quantity, count, step, first, peak, is_stated = expected
        assert (channel.component, channel.quantity, len(channel.values)) == (component, quantity, count)
        assert channel.time_step == pytest.approx(step, rel=1e-9)
        assert channel.values[0] == pytest.approx(first, abs=1e-12)
        if peak is not None:
            assert np.abs(channel.values).max() == pytest.approx(peak, rel=1e-4)
        if is_stated:
            offset = channel.values.mean() if form in ("K-NET", "KiK-net") else 0.0
            assert np.abs(channel.values - offset).max() == pytest.approx(channel.stated_peak, rel=1e-3)
    assert all(remark.startswith("digitised at uneven times") for remark in record.remarks)


def test_titles_name_the_station():
    for name, form in EXPECTED.items():
        if form[0] != "columns of text":
            assert any(word in read_record(SAMPLES / name).title.lower() for word in ("test pier 3", "smp001")), name


def test_points_from_film_are_joined_by_straight_lines():
    """Two points at the same time count with their mean; the peak is compared before."""
    (channel,) = read_record(SAMPLES / "sample_film.smc").channels
    points = [line for line in (SAMPLES / "sample_film.smc").read_text().splitlines()[-3:]]
    numbers = [float(line[at : at + 10]) for line in points for at in range(0, 80, 10)]
    times, values = np.array(numbers[::2]), GAL * np.array(numbers[1::2])
    mean = 0.5 * (values[2] + values[3])
    expected = np.interp(0.00635 * np.arange(11), np.delete(times, 3), np.delete([*values[:2], mean, *values[3:]], 3))
    np.testing.assert_allclose(channel.values, expected, rtol=1e-12)
    assert channel.stated_peak == pytest.approx(0.2284)


def test_channels_of_two_files_in_one(tmp_path):
    path = tmp_path / "two"
    path.write_bytes(2 * (SAMPLES / "sample.V1c").read_bytes() + b"\x1a\x1a")
    one, two = read_record(path).channels
    np.testing.assert_array_equal(one.values, two.values)


def test_a_column_of_times_has_a_beginning(tmp_path):
    path = changed(tmp_path, "sample.csv", ("# Sample", "#\n# of 1 m^400, no unit\n# Sample"))
    assert {channel.begin for channel in read_record(path).channels} == {2.0}


def test_a_wrong_peak_in_the_header_is_remarked_on(tmp_path):
    record = read_record(changed(tmp_path, "sample.v1", ("-1.2345670", "-1.2500000")))
    assert record.remarks == ("90: the header states a peak of 12.26 m/s², the samples have 12.11 m/s²",)
    assert read_record(changed(tmp_path, "sample.v1", ("-1.2345670", "    -1.235"))).remarks == ()  # rounded


@pytest.mark.parametrize("stated", ["sampling: 200 Hz", "200 samples/s", "Sampling rate (Hz): 200", "fs = 200 Hz"])
def test_a_sampling_rate_takes_the_place_of_the_time_step(tmp_path, stated):
    (channel,) = read_record(changed(tmp_path, "sample_step.txt", ("dt = 5 ms", f"corner 25 Hz, {stated}"))).channels
    assert (channel.time_step, channel.unit) == (0.005, "cm/s²")


def test_a_given_unit_replaces_one_of_the_same_quantity(tmp_path):
    without = changed(tmp_path, "sample_step.txt", ("[cm/s²]", ""))
    assert refusal(without) == (
        "PATH, read as columns of text: states no unit of the values; give it by --unit: "
        "g, gal, cm/s², m/s², cm/s, m/s, cm or m"
    )
    (channel,) = read_record(without, "gal").channels
    assert np.abs(channel.values).max() == pytest.approx(0.5)
    record = read_record(SAMPLES / "sample_step.txt", "m/s²")
    assert np.abs(record.channels[0].values).max() == pytest.approx(50.0)
    assert record.remarks == ("--unit: m/s² given, the header says cm/s²",)
    assert refusal(without, "kPa") == "--unit: is kPa, must be one of g, gal, cm/s², m/s², cm/s, m/s, cm or m"


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("sample.AT2", ("NPTS=     18", "NPTS=     21"), "PEER AT2/VT2/DT2: ends at line 8, after 18 of 21 numbers"),
        ("sample.AT2", (".0050 SEC", ".0000 SEC"), "PEER AT2/VT2/DT2: has a time step of 0 s, must be positive"),
        ("sample.v1", (" 8 Accel", "17 Accel"), "CSMIP V1/V2: line 30 ends the channel after 8 of 17 numbers or fewer"),
        ("sample.v1", (" 8 Accel", " 3 Accel"), "CSMIP V1/V2: line 29 has more than the last of 3 numbers"),
        ("sample.v1", ("(8f9.6)", "(8f8.6)"), 'CSMIP V1/V2: line 29 has "0 -.5009" in place of a number'),
        ("sample.v2", ("/&", "1.0"), "CSMIP V1/V2: line 55 does not end the channel, after 12 samples"),
        (
            "sample.V1c",
            ("units=g.     (02)", "units=counts (50)"),
            "COSMOS: has counts (counts), must have accelerations",
        ),
        ("sample.EW", ("/6182761", ""), "K-NET/KiK-net: lines 1 to 17 do not state Scale Factor"),
        ("sample.smc", ("2 CORRECTED ACCELEROGRAM", "5 RESPONSE SPECTRA"), "USGS SMC: holds a spectrum"),
        ("sample_film.smc", ("5.8000E-3", "5.8000E+3"), "USGS SMC: must have times that increase"),
        ("sample_step.txt", ("dt = 5 ms", ""), "columns of text: has one column and states no time step"),
        ("sample.csv", ("0.311192", "nan"), "columns of text: sample 12 is nan, must be finite"),
    ],
)
def test_damage_is_located(tmp_path, name, change, said):
    assert refusal(changed(tmp_path, name, change)).startswith(f"PATH, read as {said}")


def test_other_files_are_refused_with_the_formats_known(tmp_path):
    for content in (b"", b"\x00\x01\x02" * 100, b"some words\nof prose\n", b"\xff\xfe"):
        path = tmp_path / "other"
        path.write_bytes(content)
        assert refusal(path).endswith(
            "; known formats: PEER AT2/VT2/DT2, CSMIP V1/V2, COSMOS, K-NET/KiK-net, USGS SMC, columns of text"
        )
    assert refusal(tmp_path / "absent") == "no file PATH"


class Added(Format):
    """A format of another package."""

    name = "added"

    def recognises(self, lines):
        return lines[0] == "added"

    def read(self, source: Source) -> Record:
        return Record("added", "", ())


def test_other_packages_add_formats(monkeypatch):
    entry = EntryPoint("added", f"{__name__}:Added", "dembound.records")
    monkeypatch.setattr(EntryPoint, "load", lambda entry: Added)
    monkeypatch.setattr(table, "_registered", lambda: EntryPoints([entry]))
    assert table.with_registered("dembound.records", Format, TYPES) == (*TYPES, Added)

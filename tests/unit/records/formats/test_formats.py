"""Files of ground motion in the formats of networks, whole and damaged; samples/README.md has their sources."""

import random
import sys
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.records.formats import Reading, read_record

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
    "sample.ASC": ("ESM/ITACA ASC", [("HNE", "acceleration", 18, 0.005, 0.168819 * GAL, 0.300022 * GAL, True)]),
    "sample.V2A": (
        "GeoNet V2A",
        [
            ("N10E", "acceleration", 12, 0.02, -0.0122, 2.3646, True),
            ("N10E", "velocity", 12, 0.02, -0.25331, 0.29849, True),
            ("N10E", "displacement", 12, 0.02, 0.094531, 0.099407, True),
        ],
    ),
    "sample.dat": (
        "CWB",
        [
            ("U", "acceleration", 15, 0.02, 0.299 * GAL, 0.479 * GAL, True),
            ("N", "acceleration", 15, 0.02, 0.658 * GAL, 2.273 * GAL, True),
            ("E", "acceleration", 15, 0.02, 0.12 * GAL, 0.778 * GAL, True),
        ],
    ),
    "sample_nsmn.txt": (
        "NSMN",
        [
            ("N-S", "acceleration", 15, 0.01, 9.679757 * GAL, 13.200332 * GAL, True),
            ("E-W", "acceleration", 15, 0.01, -0.416071 * GAL, 1.843948 * GAL, True),
            ("U-D", "acceleration", 15, 0.01, 2.581487 * GAL, 2.691239 * GAL, True),
        ],
    ),
    "sample.191": (
        "UNAM",
        [
            ("V", "acceleration", 15, 0.005, 6.8783 * GAL, 11.5352 * GAL, True),
            ("N00E", "acceleration", 15, 0.005, 44.2296 * GAL, 58.7394 * GAL, True),
            ("N90E", "acceleration", 15, 0.005, -17.4381 * GAL, 27.0636 * GAL, True),
        ],
    ),
    "sample_bhrc.V1": ("BHRC V1", [("L1", "acceleration", 20, 0.005, -0.00114699 * G, 0.00114699 * G, False)]),
    "sample.e0a": ("USC V1", [("S05W", "acceleration", 15, 0.004, 0.0046 * G, 0.0046 * G, False)]),
    "sample.s0a": (
        "USC V2",
        [
            ("N08W", "acceleration", 10, 0.02, -59.542 * GAL, 242.395 * GAL, True),
            ("N08W", "velocity", 10, 0.02, -5.461 * GAL, 12.057 * GAL, True),
            ("N08W", "displacement", 10, 0.02, -0.559 * GAL, 1.42 * GAL, True),
        ],
    ),
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
    text = (SAMPLES / name).read_bytes().decode(errors="surrogateescape")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "record"
    path.write_bytes(text.encode(errors="surrogateescape"))
    return path


def refusal(path: Path, given: Reading = Reading()) -> str:  # noqa: B008
    """The one line of the error with which a file is refused, without its path."""
    with pytest.raises(CaseError) as refused:
        read_record(path, given)
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


def test_a_wrong_peak_in_the_header_is_refused_and_with_the_unit_remarked_on(tmp_path):
    wrong = changed(tmp_path, "sample.v1", ("-1.2345670", "-1.2500000"))
    said = "90: the header states a peak of 12.26 m/s², the samples have 12.11 m/s²"
    assert refusal(wrong).endswith("line 1 begins a text with a peak of 1.235, below is 1.25; --unit takes that")
    assert read_record(wrong, Reading("g")).remarks == (said,)
    assert read_record(changed(tmp_path, "sample.v1", ("-1.2345670", "    -1.235"))).remarks == ()  # rounded


@pytest.mark.parametrize("stated", ["200 samples/s", "Sampling rate (Hz): 200"])
def test_a_sampling_rate_takes_the_place_of_the_time_step(tmp_path, stated):
    (channel,) = read_record(changed(tmp_path, "sample_step.txt", ("dt = 5 ms", f"corner 25 Hz, {stated}"))).channels
    assert (channel.time_step, channel.unit) == (0.005, "cm/s²")


def test_a_given_unit_replaces_one_of_the_same_quantity(tmp_path):
    without = changed(tmp_path, "sample_step.txt", ("[cm/s²]", ""))
    assert refusal(without) == (
        "PATH, read as columns of text: states no unit of the values; give it by --unit: "
        "g, gal, cm/s², m/s², cm/s, m/s, cm or m"
    )
    (channel,) = read_record(without, Reading("gal")).channels
    assert np.abs(channel.values).max() == pytest.approx(0.5)
    record = read_record(SAMPLES / "sample_step.txt", Reading("m/s²"))
    assert np.abs(record.channels[0].values).max() == pytest.approx(50.0)
    assert record.remarks == ("--unit: m/s² given, the header says cm/s²",)
    assert refusal(without, Reading("kPa")) == "--unit: is kPa, must be one of g, gal, cm/s², m/s², cm/s, m/s, cm or m"


def test_one_unit_is_not_given_to_several_quantities(tmp_path):
    """Velocities and displacements would become accelerations."""
    said = "--unit: is g, but the channels are different quantities; leave it out"
    assert refusal(changed(tmp_path, "sample.v2"), Reading("g")).endswith(said)


def test_a_unit_is_not_given_in_place_of_its_tenths(tmp_path):
    said = "--unit: is g, the header states tenths of g; leave it out"
    assert refusal(changed(tmp_path, "sample.e0a"), Reading("g")).endswith(said)


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("sample.AT2", ("NPTS=     18", "NPTS=     21"), "PEER AT2/VT2/DT2: ends at line 8, after 18 of 21 numbers"),
        (
            "sample.v1",
            (" 8 Accel", "17 Accel"),
            "CSMIP, USC or BHRC V1/V2: line 30 ends the channel after 8 of 17 numbers or fewer",
        ),
        ("sample.v1", ("(8f9.6)", "(8f8.6)"), 'CSMIP, USC or BHRC V1/V2: line 29 has "0 -.5009" in place of a number'),
        (
            "sample.V1c",
            ("units=g.     (02)", "units=counts (50)"),
            "COSMOS: has counts (counts), must be converted to accelerations",
        ),
        ("sample.EW", ("/6182761", ""), "K-NET/KiK-net: lines 1 to 17 do not state Scale Factor"),
        ("sample_film.smc", ("5.8000E-3", "5.8000E+3"), "USGS SMC: must have times that increase"),
        ("sample.csv", ("0.311192", "nan"), "columns of text: sample 12 is nan, must be finite"),
    ],
)
def test_damage_is_located(tmp_path, name, change, said):
    assert refusal(changed(tmp_path, name, change)).startswith(f"PATH, read as {said}")


def test_other_files_are_refused_with_the_formats_known(tmp_path):
    for content in (b"", b"some words\nof prose\n", b"\xff\xfe"):
        path = tmp_path / "other"
        path.write_bytes(content)
        assert refusal(path).endswith(
            "; known formats: GeoNet V1A/V2A, CSMIP, USC or BHRC V1/V2, COSMOS, K-NET/KiK-net, USGS SMC, "
            "ESM/ITACA ASC, CWB, NSMN, UNAM, PEER AT2/VT2/DT2, columns of text"
        )
    assert refusal(tmp_path / "absent") == "no file PATH"


class Trace:
    """A trace of ObsPy with three channels' worth of nothing but what is read of it."""

    id = "XX.SMP..HNE"
    data = np.arange(5)

    def __init__(self, channel: str) -> None:
        self.stats = SimpleNamespace(channel=channel, delta=0.01, starttime="2021-02-28")


class Stream(list):
    """A stream of ObsPy."""

    def merge(self, method):
        return self


def test_binary_files_are_read_by_obspy_with_a_unit(tmp_path, monkeypatch):
    path = tmp_path / "binary"
    path.write_bytes(b"\x00\x01\x02" * 100)
    monkeypatch.setitem(sys.modules, "obspy", None)
    assert refusal(path).endswith("SAC and MiniSEED need ObsPy: install dembound[seismology]")

    def read(file, format):
        if format == "MSEED":
            raise TypeError(format)
        return Stream(map(Trace, channels))

    channels = ["HNE", "HNN"]
    monkeypatch.setitem(sys.modules, "obspy", SimpleNamespace(read=read))
    assert "states no unit of the values; give it by --unit" in refusal(path)
    record = read_record(path, Reading("cm/s2"))
    assert [(each.component, each.time_step, each.values[-1]) for each in record.channels] == [
        ("HNE", 0.01, 0.04), ("HNN", 0.01, 0.04),
    ]  # fmt: skip
    assert record.format == "SAC"
    channels = ["HNE", "HNE"]
    assert refusal(path, Reading("cm/s2")).endswith(
        "has gaps in channel HNE; keep the samples before or behind them alone"
    )


PRISTINE = sorted(SAMPLES.glob("sample*"))
CHANGES = 400
TEXTS = [b"", b"\0", b"nan", b"inf", b"1e999", b"99999999999999999999", b"-999", b"*" * 9, b"\xff", b","]


def damaged(content: bytes, draw: random.Random) -> bytes:
    """A content with one to three changes of bytes, words, lines or its length."""
    for _ in range(draw.randint(1, 3)):
        at = draw.randrange(len(content) + 1)
        lines = content.split(b"\n")
        line = draw.randrange(len(lines))
        match draw.randrange(7):
            case 0:
                content = content[:at] + bytes([draw.randrange(256)]) + content[at + 1 :]
            case 1:
                content = content[:at] + content[at + draw.randint(1, 40) :]
            case 2:
                content = content[: at + draw.randint(1, 40)] + content[at:]
            case 3:
                content = b"\n".join(lines[:line] + lines[line + 1 :])
            case 4:
                content = b"\n".join(lines[: line + 1] + lines[line:])
            case 5:
                content = content[:at]
            case 6:
                words = lines[line].split(b" ")
                words[draw.randrange(len(words))] = draw.choice(TEXTS)
                content = b"\n".join([*lines[:line], b" ".join(words), *lines[line + 1 :]])
    return content


def test_only_one_line_errors_come_of_damage(tmp_path):
    draw, path, problems = random.Random(5), tmp_path / "record", []
    contents = [sample.read_bytes() for sample in PRISTINE]
    for number in range(CHANGES):
        content = damaged(contents[number % len(contents)], draw)
        path.write_bytes(content)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                record = read_record(path)
        except CaseError as error:
            problems.append(error.problems)
            continue
        for channel in record.channels:
            assert np.isfinite(channel.values).all()
            assert len(channel.values) > 2
            assert channel.time_step > 0.0
            assert np.isfinite([channel.time_step, channel.begin, channel.stated_peak or 0.0]).all()
    assert {len(lines) for lines in problems} == {1}
    assert 0.2 * CHANGES < len(problems) < 0.9 * CHANGES

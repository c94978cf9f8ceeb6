"""The commands for measured signals: options for reading, treatment and evaluation."""

import h5py
import numpy as np
import pytest
from gauge_records import DECAY, LENGTH, POSITION, SPEED, keysight, noise, signal
from hopkinson_bar import MODULUS, SPECIMEN_MODULUS, signals

TEST = (
    *("--wave-speed", 5000, "--density", 7800, "--bar-diameter", 0.02, "--incident-gauge", 1),
    *("--transmitted-gauge", 0.8, "--specimen-length", 0.01, "--specimen-diameter", 0.016),
)


def write(path, signal, values):
    """A text file in µs and µε, compression negative, with an offset, and noise by which no plateau looks clipped."""
    noise = np.random.default_rng(1).standard_normal(len(values))
    rows = np.column_stack([1e6 * signal.time, -1e6 * values + 20.0 + noise])
    np.savetxt(path, rows, delimiter=";", header="Time (µs);strain (µε)", comments="", encoding="utf-8", fmt="%.6f")


def slope(text):
    """The modulus that is printed, Pa."""
    (line,) = (line for line in text.splitlines() if "stress over strain" in line)
    return 1e9 * float(line.split(")")[1].split()[0])


def test_a_test_is_evaluated_from_two_files(dembound, tmp_path) -> None:
    given = signals()
    write(tmp_path / "incident.csv", given, given.incident)
    write(tmp_path / "transmitted.csv", given, -given.transmitted)
    files = ("incident.csv", "transmitted.csv")
    wrong = dembound("hopkinson", *files, *TEST)
    said = "TRANSMITTED: its sign is opposite to that of the incident pulse; if it is wired so, --opposite\n"
    assert (wrong.code, wrong.err) == (2, said)
    told = dembound("hopkinson", *files, *TEST, "--opposite", "-o", "h.png", "--table", "h.csv")
    assert (told.code, told.err) == (0, "")
    assert slope(told.out) == pytest.approx(SPECIMEN_MODULUS, rel=0.01)
    assert told.out.count("baseline: removed offset") == 2
    assert (tmp_path / "h.png").read_bytes().startswith(b"\x89PNG")
    table = np.genfromtxt(tmp_path / "h.csv", delimiter=",", names=True)
    assert table["stress_3_waves_Pa"].max() == pytest.approx(MODULUS * 1e-3 * (0.02 / 0.016) ** 2, rel=0.02)
    assert set(table["in_equilibrium"]) == {0.0, 1.0}


def test_a_test_is_evaluated_from_the_record_of_a_run(dembound, tmp_path) -> None:
    write_run(tmp_path / "run.h5")
    told = dembound("hopkinson", *MONITORS)
    assert (told.code, told.err) == (0, "")
    assert slope(told.out) == pytest.approx(SPECIMEN_MODULUS, rel=0.01)
    wrong = dembound("hopkinson", *MONITORS[:-2])
    assert (wrong.code, wrong.err) == (2, "--column: is missing, must be one of back, front in run.h5\n")


def test_a_gauge_has_its_columns_units_and_filters(dembound, tmp_path) -> None:
    time, values = signal().T
    values = noise(0.005)(time, values) + 0.1 * np.sin(2e6 * time) + 0.3
    (tmp_path / "scope.csv").write_text("\n".join(keysight(time, values)), encoding="utf-8")
    bar = ("--position", POSITION, "--length", LENGTH)
    missing = dembound("gauge", "scope.csv", *bar)
    assert missing == (2, "", "--column: is missing, scope.csv has 3 columns; must be 1, 2\n")
    told = dembound("gauge", "scope.csv", *bar, "--column", 3, "--low-pass", 60e3, "--notch", 318.31e3)
    assert (told.code, told.err) == (0, "")
    assert "column 3, 2 (Volt): 5000 samples, one every 1 µs" in told.out
    speed, decay = (line.split(")")[1].split() for line in told.out.splitlines() if "m)" in line or "m/s)" in line)
    assert float(speed[0]) == pytest.approx(SPEED, rel=0.005)
    assert float(decay[0]) == pytest.approx(DECAY, rel=0.05)
    raw = dembound("gauge", "scope.csv", *bar, "--column", 3, "--no-baseline", "--spall", 0.79, "--wave-speed", 2740)
    assert raw.code == 2
    assert "--unit: the values are in V, strengths need stresses" in raw.err


MONITORS = ("run.h5", *TEST, "--incident-column", "front", "--transmitted-column", "back")


def write_run(path) -> None:
    """The record of a run of `TEST`."""
    given = signals()
    with h5py.File(path, "w") as file:
        for name, values in (("front", given.incident), ("back", given.transmitted)):
            group = file.create_group(f"histories/{name}")
            group["time"], group["stress"] = given.time, -MODULUS * values
            group.attrs["position"] = [1.0, 0.0]


@pytest.mark.slow
def test_a_picture_and_its_table_are_written(dembound, small_run, spalled_run, tmp_path):
    for options, head in (
        (("--show", "fourier", "--quantity", "acceleration", "--component", "both"), "frequency (Hz),"),
        (("--show", "transfer", "--reference", "front"), "frequency (Hz) of small,"),
        (("--show", "response", "--component", "x"), "period (s),"),
        (("--show", "section"), "time (ms),"),
        (("--show", "hodograph", "--monitor", "front"), "velocity along x (m/s),"),
    ):
        answer = dembound("signals", small_run, *options)
        assert (answer.code, answer.out) == (0, "wrote signals.png\nwrote signals.csv\n")
        assert (tmp_path / "signals.png").stat().st_size > 0
        assert (tmp_path / "signals.csv").read_text().startswith(head)
    answer = dembound("signals", spalled_run, "--quantity", "stress", "-o", "bar.png")  # by default a spectrum
    assert (answer.code, answer.out) == (0, "wrote bar.png\nwrote bar.csv\n")
    assert "gauge, spalled: Fourier amplitude of the stress (MPa·s)" in (tmp_path / "bar.csv").read_text()


def test_options_without_effect_are_refused(dembound, small_run, tmp_path):
    for options, problem in (
        (("--reference", "front"), "--reference: goes with --show transfer"),
        (("--show", "response", "--quantity", "velocity"), "--quantity: is not allowed with --show response"),
        (("--show", "hodograph", "--component", "x"), "--component: is not allowed with --show hodograph"),
    ):
        answer = dembound("signals", small_run, *options)
        assert answer.code == 2
        assert answer.err.startswith(problem)
    assert not list(tmp_path.iterdir())

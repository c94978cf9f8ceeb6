"""What joining the samples of a record by straight lines, or by the band-limited function, takes from its motion.

    python benchmarks/record_interpolation.py

Bursts of 4 s, a sine under sin⁴, are sampled 100 times per second, and read as a wave of `type = "file"`. Their
amplitude is that of the wave between samples over the exact one, weighted by the burst. Response spectra are those of
the acceleration of noise below 40 Hz, differentiated at 0.25 ms.
"""

import argparse
from collections.abc import Iterator

import numpy as np
from timing import show, small_option

from dembound.spectra import response_spectrum
from dembound.waves import FileWave

STEP, LENGTH, FINE = 0.01, 4.0, 128
"""Time between samples and length of the bursts, s; points in place of a sample at which they are compared."""

FREQUENCIES = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0)
"""Frequencies of bursts, Hz."""

PERIODS = (0.1, 0.05, 0.03, 0.025, 0.02, 0.015, 0.01)
"""Periods of oscillators, s."""

WAYS = ("lines", "band_limited")


def wave_of(values: np.ndarray, interpolation: str) -> FileWave:
    """The wave of a file with these samples."""
    text = "\n".join(f"{STEP * row!r} {value!r}" for row, value in enumerate(values.tolist()))
    table = {"type": "file", "path": "record.txt", "interpolation": interpolation}
    return FileWave.model_validate(table, context={"files": {"record.txt": text}})


def bursts() -> Iterator[dict[str, float]]:
    """For each frequency the amplitude that is kept, and the largest error over the peak."""
    time = np.linspace(0.0, LENGTH, round(LENGTH / STEP) * FINE + 1)
    envelope = np.sin(np.pi * time / LENGTH) ** 4
    for frequency in FREQUENCIES:
        exact = envelope * np.sin(2.0 * np.pi * frequency * time + 0.3)
        weight = envelope * np.exp(-2j * np.pi * frequency * time)
        row = {"frequency": frequency}
        for way in WAYS:
            found = wave_of(exact[::FINE], way).velocity(time)
            row[way] = float(abs(weight @ found) / abs(weight @ exact))
            row[f"{way}_error"] = float(np.abs(found - exact).max() / np.abs(exact).max())
        yield row


def oscillators() -> Iterator[dict[str, float]]:
    """For each period the response under the wave over that under the exact motion."""
    count = round(LENGTH / STEP)
    spectrum = np.fft.rfft(np.random.default_rng(4).standard_normal(count)) * (np.fft.rfftfreq(count, STEP) < 40.0)
    finer = 40
    wide = np.zeros(count * finer // 2 + 1, dtype=complex)
    wide[: len(spectrum)] = spectrum
    time = STEP / finer * np.arange(count * finer)
    exact = np.fft.irfft(wide, count * finer) * np.sin(np.pi * time / LENGTH) ** 4
    periods = np.array(PERIODS)

    def response(velocity: np.ndarray) -> np.ndarray:
        return response_spectrum(np.gradient(velocity, time[1]), time[1], periods).pseudo_acceleration

    samples = np.append(exact[::finer], 0.0)
    whole = response(exact)
    found = {way: response(wave_of(samples, way).velocity(time)) / whole for way in WAYS}
    for number, period in enumerate(PERIODS):
        yield {"period": period} | {way: float(each[number]) for way, each in found.items()}


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    small_option(parser)  # all takes a second
    parser.parse_args()
    kept = {"frequency (Hz)": "{frequency:g}", "of 100 samples/s": "{share:.2f}"}
    kept |= {way: f"{{{way}:.4f}}" for way in WAYS} | {f"error, {way}": f"{{{way}_error:.2%}}" for way in WAYS}
    rows = ({**row, "share": row["frequency"] * STEP} for row in bursts())
    show("amplitude kept, largest error over the peak", kept, rows)
    of_oscillators = {"period (s)": "{period:g}"} | {way: f"{{{way}:.3f}}" for way in WAYS}
    show("pseudo-acceleration over that of the exact motion", of_oscillators, oscillators())


if __name__ == "__main__":
    main()

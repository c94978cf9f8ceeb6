"""Records of strain gauges with all usual mistakes, made from the exact motion of a bar.

The bar is 0.99 m long, its gauge at 0.6 m, c = 2740 m/s, α = 0.52 1/m. A triangular pressure pulse enters one end and
runs to and fro between free ends. Its crest at the gauge is 1; the strong pulse, which falls longer, is drawn once.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dembound.gauge.baseline import Filters, Treatment
from dembound.gauge.gauge_io import Gauge, read_gauge
from dembound.gauge.reading.signal import Reading

LENGTH, POSITION, SPEED, DECAY = 0.99, 0.6, 2740.0, 0.52
DENSITY = 2620.0
SPALL = 0.79
"""Place where the strong pulse breaks the bar, m."""

Change = Callable[[np.ndarray, np.ndarray], np.ndarray]


def signal(samples: int = 5000, step: float = 1e-6, start: float = 20e-6, fall: float = 80e-6) -> np.ndarray:
    """Times and the exact signal (k, 2) at the gauge; tension is positive."""
    time = step * np.arange(samples)
    values = np.zeros_like(time)
    for turn in range(60):
        for sign, way in ((-1.0, 2.0 * turn * LENGTH + POSITION), (1.0, 2.0 * (turn + 1) * LENGTH - POSITION)):
            since = time - start - way / SPEED
            triangle = np.clip(np.minimum(since / 40e-6, 1.0 - (since - 40e-6) / fall), 0.0, 1.0)
            values += sign * np.exp(-DECAY * (way - POSITION)) * triangle
    return np.column_stack([time, values])


def exact_nominal(fall: float = 200e-6) -> float:
    """Largest tension at the spall over the crest at the gauge, without attenuation: 2d/(c t_f), d from the end."""
    return 2.0 * (LENGTH - SPALL) / (SPEED * fall)


def noise(level: float, seed: int = 1) -> Change:
    """White noise of this standard deviation over the crest."""
    return lambda time, values: values + level * np.random.default_rng(seed).standard_normal(len(time))


def offset(level: float) -> Change:
    """A constant."""
    return lambda time, values: values + level


def drift(level: float) -> Change:
    """A straight line from 0 to this level."""
    return lambda time, values: values + level * time / time[-1]


def hum(level: float, frequency: float = 50.0, phase: float = 1.0) -> Change:
    """The mains."""
    return lambda time, values: values + level * np.sin(2.0 * np.pi * frequency * time + phase)


def bits(number: int, reach: float = 1.28) -> Change:
    """A digitiser of this many bits from -reach to reach, which clips beyond."""
    step = 2.0 * reach / 2**number
    return lambda time, values: np.clip(np.round(values / step) * step, -reach, reach - step)


def clip(level: float) -> Change:
    """Values of the compression beyond this level are cut."""
    return lambda time, values: np.maximum(values, -level)


def ring(level: float, frequency: float = 150e3) -> Change:
    """Oscillation at a high frequency."""
    return lambda time, values: values + level * np.sin(2.0 * np.pi * frequency * time)


def sign(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Compression positive."""
    del time
    return -values


def plain(time: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """Two columns with blanks and no header."""
    yield from (f"{t:.9e} {value:.9e}" for t, value in zip(time, values, strict=True))


def keysight(time: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """A line of axes, one of units, and another channel."""
    yield from ("x-axis,1,2", "second,Volt,Volt")
    yield from (f"{t:+.9e}, {0.1:.3e}, {value:.6e}" for t, value in zip(time, values, strict=True))


def picoscope(time: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """Decimal commas, ms and mV, and an empty line."""
    yield from ("Zeit;Kanal A;Kanal B", "(ms);(mV);(V)", "")
    rows = zip(1e3 * time, 1e3 * values, strict=True)
    yield from (f"{t:.6f};{value:.5f};{0.0:.2f}".replace(".", ",") for t, value in rows)


@dataclass(frozen=True)
class Record:
    """A record: what is wrong with it, how it is written and read; refused : the words of its refusal, if it must."""

    name: str
    changes: tuple[Change, ...] = ()
    writer: Callable[[np.ndarray, np.ndarray], Iterator[str]] = plain
    sampling: dict[str, float] = field(default_factory=dict)
    reading: Reading | None = None
    treatment: Treatment | None = None
    length: float = LENGTH
    refused: str = ""

    def gauge(self, path: Path, fall: float = 80e-6) -> Gauge:
        """Write the text file, and read it."""
        time, values = signal(fall=fall, **self.sampling).T
        for change in self.changes:
            values = change(time, values)
        path.write_text("\n".join(self.writer(time, values)) + "\n", encoding="utf-8")
        position = POSITION * self.length / LENGTH
        return read_gauge(path, None, position, self.length, DENSITY, self.reading, self.treatment)


LONG = {"samples": 20_000, "step": 2e-6, "start": 2e-3}
COARSE = {"samples": 100, "step": 50e-6, "start": 1e-3}

RECORDS = (
    Record("clean"),
    Record("noise of 3 %", (noise(0.03, 2),)),
    Record("drift of 30 %", (drift(0.3), noise(0.01))),
    Record("offset and drift, and trigger after 2 ms", (offset(0.05), drift(-0.05), noise(0.01)), sampling=LONG),
    Record("drift of 3 %, 8 bits", (drift(0.03), noise(0.003), bits(8))),
    Record("ringing of 5 % at 150 kHz", (ring(0.05),), treatment=Treatment(filters=Filters(low_pass=60e3))),
    Record("Keysight, two channels, other sign", (sign, noise(0.005)), keysight, {}, Reading("3", scale=-1.0)),
    Record("PicoScope, decimal commas, ms and mV", (noise(0.005),), picoscope, {}, Reading("Kanal A")),
    Record("clipped at 80 %", (noise(0.003), clip(0.8)), refused="the signal is clipped"),
    Record("50 µs between samples", (noise(0.003),), sampling=COARSE, refused="the sampling is too coarse"),
    Record("hum of 10 %", (hum(0.1), noise(0.005)), refused="these are not returns of one pulse"),
    Record("other sign", (sign, noise(0.005)), refused="these are not returns of one pulse"),
    Record("length in mm", (noise(0.003),), length=990.0, refused="in m, not mm"),
    Record(
        "times in s, read as ms", (noise(0.003),), reading=Reading(time_unit="ms"), refused="must be 100 to 10000 m/s"
    ),
)
"""Records of all kinds of mistakes that were seen, and of instruments."""

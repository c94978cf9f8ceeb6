"""Types of one side compared: what each returns, by frequency, of the waves of a case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.disks.beyond.frequencies import frequencies_of
from dembound.disks.beyond.settings import signals_of
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.arrivals import Arrival
from dembound.disks.reflection.meter import Kind
from dembound.outside import sizing
from dembound.outside.sizing import Signal
from dembound.spectra.fourier import smoothed

COUNT = 24
"""Number of frequencies at equal ratios."""

SEEN = 1e-4
"""Share of energy that counts as returned: 1 % of the amplitude."""


def wide_frequencies(case: DiskCase, ground: PackedMaterial) -> np.ndarray:
    """Frequencies (f,) Hz at equal ratios, from the lowest of the waves to where their spectra have faded."""
    usual = frequencies_of(case, ground, COUNT)
    signals = [signal for signal in signals_of(case) if not sizing.jumps(signal)]
    return np.geomspace(usual[0], max([usual[-1], *(each.wave.highest_frequency() for each in signals)]), COUNT)


def signal_for(kind: Kind, arrivals: Sequence[Arrival]) -> Signal | None:
    """The signal of the first arrival of a type of waves that has one."""
    return next((each.signal for each in arrivals if kind in each.kinds and each.signal is not None), None)


def amplitudes(signal: Signal, frequencies: np.ndarray) -> np.ndarray:
    """Smoothed velocity amplitudes (f,) of a signal at frequencies (Hz), over the largest of them."""
    found = np.sqrt(smoothed(*sizing.energies(signal), frequencies))
    return np.asarray(found / found.max())


def returned_range(frequencies: np.ndarray, shares: np.ndarray) -> str:
    """Where shares (f,) of energy at ascending frequencies (Hz) exceed `SEEN`, in words."""
    if (shares > SEEN).all():
        return "everywhere"
    ends = {
        "below": _crossing(frequencies, shares),
        "above": _crossing(frequencies[::-1], shares[::-1]),
    }
    return " and ".join(f"{way} {end:.3g} Hz" for way, end in ends.items() if end > 0.0) or "nowhere"


def _crossing(frequencies: np.ndarray, shares: np.ndarray) -> float:
    """Frequency (Hz) at which shares fall to `SEEN`, straight in logarithms; 0 if the first is not above it."""
    last = int(np.argmin(shares > SEEN))
    if last == 0:
        return 0.0
    (high, low), ends = np.log(np.maximum(shares[last - 1 : last + 1], 1e-30)), frequencies[last - 1 : last + 1]
    return float(ends[0] * (ends[1] / ends[0]) ** ((high - np.log(SEEN)) / (high - low)))


def words_of(table: Mapping[str, Any]) -> str:
    """A table of a side in words: its type, and its other keys with their values."""
    keys = [key if value is True else f"{key} {value}" for key, value in table.items() if key != "type"]
    return ", ".join([str(table["type"]), *keys])

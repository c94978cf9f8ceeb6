"""Waves and forces that reach a side in a case, and types of the side compared."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, get_args

import numpy as np

from dembound.boundaries.edge import Motion, axis_of_motion, normal_axis, plane_of
from dembound.casefile.disks.model import DiskCase
from dembound.continuum import sizing
from dembound.continuum.sizing import Signal
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.bricks import is_outwards
from dembound.disks.reflection.meter import Kind, Reflections
from dembound.disks.sources import place_of
from dembound.disks.surroundings.frequencies import frequencies_of
from dembound.disks.surroundings.near_fields import signals_of
from dembound.spectra import smoothed
from dembound.table import Box

PLACES = 200
"""Places along a side at which waves of a source arrive."""

FLATTEST = 85.0
"""Largest angle (degrees) from the normal that counts: flatter waves run along the side rather than reach it."""


@dataclass(frozen=True)
class Arrival:
    """Waves that reach a side.

    name : in words. kinds : their types. angles : (k,) degrees, shares : (k,) of their energy, 1 in all. signal : whose
    spectrum they have; None if it is unknown, or without finite energy.
    """

    name: str
    kinds: tuple[Kind, ...]
    angles: np.ndarray
    shares: np.ndarray
    signal: Signal | None = None

    def sent_back(self, found: Reflections) -> float:
        """Share of the energy that the side reflects: mean over types, angles and the spectrum; nan if unknown."""
        each = []
        for kind in self.kinds:
            if kind not in found.kinds or not np.isfinite(found.total(kind)).any():
                continue
            by_angle = over_spectrum(found.total(kind), found.frequencies, self.signal)
            known = np.isfinite(by_angle)
            each.append(float(self.shares @ np.interp(self.angles, found.angles[known], by_angle[known])))
        return float(np.mean(each)) if each else math.nan


def over_spectrum(shares: np.ndarray, frequencies: np.ndarray, signal: Signal | None) -> np.ndarray:
    """Means (a,) of shares (f, a) of energy at ascending frequencies (f,), Hz, weighted with the energy of a signal.

    ∫R|V|²df/∫|V|²df, with R straight over log f between the frequencies, and constant below and above them. Plain means
    without a signal. Frequencies without a known share are left out; nan where none is known.
    """
    weights = np.ones(len(frequencies)) if signal is None else _weights(signal, tuple(frequencies.tolist()))
    known = np.where(np.isfinite(shares), weights[:, None], 0.0)
    total, sums = known.sum(axis=0), (known * np.nan_to_num(shares)).sum(axis=0)
    return np.divide(sums, total, out=np.full(len(total), np.nan), where=total > 0)


@lru_cache(maxsize=64)
def _weights(signal: Signal, frequencies: tuple[float, ...]) -> np.ndarray:
    """The energy (f,) of a signal, each part of it shared by the frequencies (Hz, ascending) below and above."""
    each, energy = sizing.energies(signal)
    place = np.interp(np.log(each), np.log(frequencies), np.arange(len(frequencies)))
    below = place.astype(int)
    count = len(frequencies) + 1
    upper = np.bincount(below + 1, (place - below) * energy, count)
    return np.asarray((np.bincount(below, (1.0 - place + below) * energy, count) + upper)[:-1])


def arrivals_of(case: DiskCase, side: str, ground: PackedMaterial) -> list[Arrival]:
    """Waves that reach a side: of driven sides, towards it or along its normal, of loads and of holes.

    Without any of these all directions, as in a diffuse motion; also where waves of loads and holes cross layers, which
    turn them.
    """
    found = [*_plane(case, side), *(_spreading(case, side) if len(case.layer) < 2 else ())]
    if not found:
        angles = np.linspace(0.0, FLATTEST, PLACES)
        shares = np.cos(np.radians(angles))
        found = [Arrival("waves from all directions", ("p", "s"), angles, shares / shares.sum())]
    return found


def _signal(case: DiskCase, wave: str | None, *, is_force: bool = False) -> Signal | None:
    """The signal of a wave of the case; None for a steady force, and for a wave that jumps."""
    signal = None if wave is None else Signal(case.wave[wave], is_force)
    return None if signal is None or sizing.jumps(signal) else signal


def _plane(case: DiskCase, side: str) -> Iterator[Arrival]:
    """Plane waves: of driven sides along its normal, and an oblique incident wave."""
    for driven, waves in case.driving.items():
        if normal_axis(driven) != normal_axis(side):
            continue
        for motion, name in waves.items():
            if "xy"[axis_of_motion(driven, motion)] not in case.motion.held:
                one = np.zeros(1), np.ones(1), _signal(case, name)
                yield Arrival(f"wave {name} along the normal", (motion,), *one)
    if case.incident is not None:
        angle = abs(case.incident.angle) if normal_axis(side) == 1 else 90.0 - abs(case.incident.angle)
        kind: Kind = "p" if case.incident.type == "p" else "s"
        name = f"wave {case.incident.wave} at {angle:g}°"
        signal = _signal(case, case.incident.wave)
        yield Arrival(name, (kind,), np.array([min(angle, FLATTEST)]), np.ones(1), signal)


def _spreading(case: DiskCase, side: str) -> Iterator[Arrival]:
    """Waves that spread from loads and holes, by the angles at which they reach places along the side."""
    boxes: dict[str, tuple[Box, Signal | None]] = {
        f"load {load.name}": (place_of(case, load), _signal(case, load.wave, is_force=True))
        for load in case.load
        if not load.is_everywhere
    }
    boxes |= {f"hole {number}": (hole.box, None) for number, hole in enumerate(case.holes, start=1)}
    for name, (box, signal) in boxes.items():
        axis = normal_axis(side)
        centre = np.array([0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])])
        away = is_outwards(side) * (plane_of(side, case.box) - centre[axis])
        along = np.linspace(case.box[1 - axis], case.box[3 - axis], PLACES) - centre[1 - axis]
        if away <= 0.0:
            continue
        angles = np.degrees(np.arctan2(np.abs(along), away))
        shares = np.cos(np.radians(angles)) / np.hypot(along, away)  # of waves that spread in the plane
        near = angles <= FLATTEST
        if near.any():
            kinds: tuple[Kind, ...] = get_args(Motion)
            yield Arrival(f"waves from {name}", kinds, angles[near], shares[near] / shares[near].sum(), signal)


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
    ends = {"below": _crossing(frequencies, shares), "above": _crossing(frequencies[::-1], shares[::-1])}
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

"""Treatment of a measured signal before anything is estimated from it: baseline and filters."""

from dataclasses import dataclass, field, replace

import numpy as np

from dembound.gauge.baseline import MAINS, Baseline, find_baseline
from dembound.gauge.filters import Filters
from dembound.gauge.noise import Noise, noise_of
from dembound.gauge.reading.signal import Signal
from dembound.words import percent


@dataclass(frozen=True)
class Treatment:
    """Removal of the baseline from a signal, with or without drift and hum, and of frequencies by filters."""

    baseline: bool = True
    drift: bool = True
    hum: bool = True
    filters: Filters = field(default_factory=Filters)


def treated(signal: Signal, treatment: Treatment | None = None) -> tuple[Signal, Noise | None]:
    """The signal without its baseline, filtered, with notes on the treatment; and its noise, None if it is not known.

    A baseline below 0.3 % of the signal or below five of its standard errors is not removed. Raises CaseError for
    filters that the record does not allow.
    """
    treatment = treatment or Treatment()
    values, notes = signal.values, list(signal.notes)
    found = None
    if treatment.baseline:
        found = find_baseline(signal.time, values, drift=treatment.drift, mains=MAINS if treatment.hum else ())
        notes.append(_in_words(found, signal))
        if found is not None and found.worthwhile:
            values = values - found.values
    values, filtered = treatment.filters.apply(signal.time, values)
    noise = None if found is None else noise_of(values, found)
    return replace(signal, values=values, notes=(*notes, *filtered)), noise


def _in_words(found: Baseline | None, signal: Signal) -> str:
    """The treatment of the baseline in words."""
    if found is None:
        return "baseline: not removed, as no part of the record is quiet"
    largest = float(np.abs(signal.values - found.values).max())
    if not found.worthwhile:
        return f"baseline: nothing to remove, {percent(np.abs(found.values).max() / largest)} of the signal"
    parts = ", ".join(found.names)
    ends = dict.fromkeys(f"{value:.4g}" for value in (found.values.min(), found.values.max()))
    size = f"{' to '.join(ends)} {signal.unit}".rstrip()
    there = f"{found.quiet.sum()} quiet samples"
    if found.before:
        there += f", {found.before} of them before {signal.time[found.before - 1]:.6g} s"
    share = float(np.abs(found.values).max()) / largest
    return f"baseline: removed {parts}, {size}, {percent(share, 3)} of the signal ({there})"

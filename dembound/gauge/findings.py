"""Findings from a gauge on a bar."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.gauge.estimates import Estimate
from dembound.gauge.passages import PartialFit
from dembound.gauge.peaks import Peaks


@dataclass(frozen=True)
class Strength:
    """The strength of a bar where it has spalled.

    position : from the loaded end, m; nominal : largest tension there without attenuation, Pa, reached at `time`, s;
    way : path length from the gauge via the free end to there, m; attenuated : nominal strength attenuated over this
    path, Pa, None without a coefficient; pulse : times (p,) s and stresses (p,) Pa of the incident pulse without
    reflections; nominal_error, attenuated_error : standard errors, Pa, nan if not known.
    """

    position: float
    nominal: float
    time: float
    way: float
    attenuated: float | None
    pulse: tuple[np.ndarray, np.ndarray]
    nominal_error: float = np.nan
    attenuated_error: float = np.nan


class Misfit(NamedTuple):
    """A part of the passages that contradicts all returns: its name, its value, theirs, and the difference by noise.

    `of` is "wave speed", in m/s, or "attenuation", in 1/m.
    """

    of: str
    part: str
    there: float
    value: float
    noise: float


@dataclass(frozen=True)
class Findings:
    """Estimates from a gauge: wave speed in m/s, attenuation in 1/m, strengths in Pa; None where not estimated.

    `peaks` are the tension peaks from which speed or attenuation are estimated, None if both were given; `parts` the
    results of parts of the passages; `misfits` parts that contradict the peaks; `warnings` doubts about results.
    """

    peaks: Peaks | None
    speed: Estimate
    attenuation: Estimate | None
    strength: Strength | None
    pull_back: float | None
    parts: tuple[PartialFit, ...] = ()
    misfits: tuple[Misfit, ...] = ()
    warnings: tuple[str, ...] = ()

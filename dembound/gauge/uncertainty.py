"""Standard errors of findings: from signals with other noise, and from parts of the passages that contradict them."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from dembound.gauge.estimates import FEWEST, Estimate
from dembound.gauge.findings import Findings, Misfit
from dembound.gauge.passages import PartialFit

SURE = 4.0
"""Difference of a part of the passages from all returns above which it contradicts them, in standard errors by
noise.
"""

EXACT = 5e-4
"""Relative difference that sampling may cause without noise."""


def with_errors(found: Findings, others: Sequence[Findings]) -> Findings:
    """The findings, with the scatter of findings from other signals as standard errors.

    Errors of speed and attenuation are at least those of the lines through the peaks, and at least the difference of a
    part of the passages that contradicts all returns.
    """
    speed, of_speed = _estimated("wave speed", found, others, lambda each: each.speed, lambda part: part.speed)
    decay, of_decay = _estimated("attenuation", found, others, lambda each: each.attenuation, lambda part: part.decay)
    assert speed is not None
    strength = found.strength
    if strength is not None:
        spalls = [other.strength for other in others if other.strength is not None]
        attenuated = [each.attenuated for each in spalls if each.attenuated is not None]
        nominal_error = float(np.fmax(_scatter([each.nominal for each in spalls]), strength.nominal_error))
        strength = replace(strength, nominal_error=nominal_error, attenuated_error=_scatter(attenuated))
    misfits = tuple(each for each in (of_speed, of_decay) if each is not None)
    return replace(found, speed=speed, attenuation=decay, strength=strength, misfits=misfits)


def _estimated(
    of: str,
    found: Findings,
    others: Sequence[Findings],
    whole: Callable[[Findings], Estimate | None],
    partial: Callable[[PartialFit], float],
) -> tuple[Estimate | None, Misfit | None]:
    """An estimate with its error, and the part that contradicts it most, if any.

    of : name of the estimate. whole : returns it from findings; partial : from a part of the passages.
    """
    estimate = whole(found)
    if estimate is None or not estimate.points:
        return estimate, None
    values = [each.value for each in map(whole, others) if each is not None]
    error, worst = float(np.fmax(estimate.error, _scatter(values))), None
    for part in found.parts:
        off = abs(partial(part) - estimate.value)
        changes = [
            partial(other_part) - other_whole.value
            for other in others
            if (other_whole := whole(other)) is not None
            for other_part in other.parts
            if other_part.name == part.name
        ]
        noise = float(np.nan_to_num(_scatter(changes)))
        if off > max(SURE * noise, EXACT * estimate.value) and (worst is None or off > abs(worst.there - worst.value)):
            worst = Misfit(of, part.name, partial(part), estimate.value, noise)
    if worst is not None:
        error = float(np.fmax(error, abs(worst.there - worst.value)))
    return estimate._replace(error=error), worst


def _scatter(values: Sequence[float]) -> float:
    """Standard deviation of some values; nan for fewer than a few."""
    return float(np.std(values, ddof=1)) if len(values) >= FEWEST else np.nan

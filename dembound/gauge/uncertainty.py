"""Standard errors of findings, from those of signals with other noise."""

from dataclasses import replace

import numpy as np

from dembound.gauge.estimates import FEWEST, Estimate
from dembound.gauge.findings import Findings


def with_errors(found: Findings, others: list[Findings]) -> Findings:
    """The findings with the scatter of those from other signals as standard errors.

    Errors of speed and attenuation remain those of the lines through the peaks if these are larger.
    """
    speed = _less_certain(found.speed, [other.speed for other in others])
    decay = found.attenuation
    if decay is not None:
        decay = _less_certain(decay, [other.attenuation for other in others if other.attenuation is not None])
    strength = found.strength
    if strength is not None:
        spalls = [other.strength for other in others if other.strength is not None]
        attenuated = [each.attenuated for each in spalls if each.attenuated is not None]
        nominal_error, attenuated_error = _scatter([each.nominal for each in spalls]), _scatter(attenuated)
        strength = replace(strength, nominal_error=nominal_error, attenuated_error=attenuated_error)
    return replace(found, speed=speed, attenuation=decay, strength=strength)


def _less_certain(estimate: Estimate, others: list[Estimate]) -> Estimate:
    """An estimate with the scatter of others as its standard error if this is larger."""
    if not estimate.points:
        return estimate
    return estimate._replace(error=float(np.fmax(estimate.error, _scatter([each.value for each in others]))))


def _scatter(values: list[float]) -> float:
    """Standard deviation of some values; nan for fewer than a few."""
    return float(np.std(values, ddof=1)) if len(values) >= FEWEST else np.nan

"""Relaxation mechanisms that make the quality factor Q of a material nearly constant over a band of frequencies.

With e^{iωt} the modulus of K mechanisms of weights w and times τ is

    M(ω) = M_U m(ω) ,   m(ω) = 1 − Σ w/(1 + iωτ) ,   1/Q(ω) = Im M/Re M ,

with the unrelaxed modulus M_U of fast deformations. If a wave is to have the speed of the modulus M₀ at the frequency
f₀, M_U/M₀ = [Re m(f₀)^(−1/2)]². All internal forces on a node then obey F = m(ω) f, with f those of the unrelaxed
moduli, which a memory p of each mechanism does at every step (Δt): r = p + g f, p ← e r + g f, F = f − Σ r, with
e = exp(−Δt/τ) and g = w (1 − e)/2.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dembound.damping.attenuation import Attenuation

FIT_POINTS = 60
"""Frequencies at which Q is fitted, denser at the ends of the band, where errors are largest."""

ROUNDS = 12
"""Rounds in which frequencies with large errors get more weight, so that the largest error becomes small."""

DIGITS = 6
"""Significant digits of fitted weights and times: the last bits of a fit depend on the machine."""


@dataclass(frozen=True)
class Mechanisms(Attenuation):
    """Relaxation mechanisms of one material.

    Attributes
    ----------
    weights, times : w, pure numbers, and τ, s, of each mechanism. frequency : f₀, Hz, at which the given wave speeds
    hold. band : lowest and highest frequency, Hz, over which Q is nearly constant.
    """

    weights: tuple[float, ...]
    times: tuple[float, ...]
    frequency: float
    band: tuple[float, float]

    def relative_modulus(self, frequency: np.ndarray | float) -> np.ndarray:
        """M(ω)/M₀ (...) at frequencies (...) Hz, which may be complex, for e^{iωt}; M₀ is ρc² of the given speed."""
        return self.unrelaxed * _factor(np.array(self.weights), np.array(self.times), np.asarray(frequency))

    @property
    def unrelaxed(self) -> float:
        """M_U/M₀."""
        at = _factor(np.array(self.weights), np.array(self.times), np.asarray(self.frequency))
        return float(np.real(at**-0.5) ** 2)

    @property
    def count(self) -> int:
        """Number of mechanisms."""
        return len(self.weights)

    def per_step(self, time_step: float) -> np.ndarray:
        """Factors e and g (2, K) of the memories for steps of this length (s)."""
        decay = np.exp(-time_step / np.array(self.times))
        return np.stack([decay, 0.5 * np.array(self.weights) * (1.0 - decay)])


def _factor(weights: np.ndarray, times: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """m(ω) (...) at frequencies (...) Hz."""
    terms = weights / (1.0 + 2j * math.pi * frequency[..., None] * times)
    return np.asarray(1.0 - terms.sum(axis=-1))


@lru_cache(maxsize=256)
def fitted(quality: float, band: tuple[float, float], frequency: float, count: int) -> Mechanisms:
    """`count` mechanisms fitted to a constant Q over a band (Hz), for wave speeds that hold at a frequency (Hz)."""
    low, high = band
    middle, span = math.sqrt(low * high), math.log(high / low)
    weights, relative = _fit(float(quality), round(span, 9), count)
    times = [rounded(time / middle) for time in relative]
    return Mechanisms(tuple(map(rounded, weights)), tuple(times), frequency, band)


@lru_cache(maxsize=256)
def _fit(quality: float, span: float, count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Weights, and times × middle frequency, of a fit over exp(−span/2) … exp(span/2) middle frequencies.

    Weighted least squares of Q·(1/Q(ω)) − 1 over log w and log τ; weights that grow with the errors make it a fit of
    the least largest error (Lawson).
    """
    from scipy.optimize import least_squares

    angle = (np.arange(FIT_POINTS) + 0.5) * math.pi / FIT_POINTS
    frequency = np.exp(0.5 * span * np.cos(angle))
    share = np.ones(FIT_POINTS)

    def error(logs: np.ndarray) -> np.ndarray:
        modulus = _factor(np.exp(logs[:count]), np.exp(logs[count:]), frequency)
        return np.asarray(quality * modulus.imag / modulus.real - 1.0)

    def weighted(logs: np.ndarray, roots: np.ndarray) -> np.ndarray:
        return np.asarray(roots * error(logs))

    inner = 0.5 * span * (1.0 - 0.5 / count) * np.linspace(1.0, -1.0, count) if count > 1 else np.zeros(1)
    logs = np.concatenate(
        [np.full(count, math.log(span / (2.0 * count * quality) + 1e-3)), inner - math.log(2.0 * math.pi)]
    )
    best, least = logs, math.inf
    for _ in range(ROUNDS):
        logs = least_squares(weighted, logs, args=(np.sqrt(share),), xtol=1e-12, ftol=1e-12).x
        errors = np.abs(error(logs))
        if errors.max() < least:
            best, least = logs, float(errors.max())
        share = share * (errors / errors.mean() + 1e-3)
        share *= FIT_POINTS / share.sum()
    weights, times = np.exp(best).reshape(2, count)
    order = np.argsort(-times)
    return tuple(weights[order].tolist()), tuple(times[order].tolist())


def rounded(value: float) -> float:
    """A number with `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}")

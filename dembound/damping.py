"""Damping of ground: relaxation mechanisms with a quality factor, and Rayleigh damping."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np


class Attenuation(ABC):
    """Damping of one material.

    Attributes
    ----------
    band : lowest and highest frequency, Hz, for which it is fitted. frequency : f₀, Hz, at which the given wave speeds
    hold.
    """

    band: tuple[float, float]
    frequency: float

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of memories of each force."""

    @abstractmethod
    def per_step(self, time_step: float) -> np.ndarray:
        """Factors e and g (2, K) of the memories for steps of this length (s), see dembound/damping.py."""

    @abstractmethod
    def relative_modulus(self, frequency: np.ndarray | float) -> np.ndarray:
        """M(ω)/M₀ (...) at frequencies (...) Hz, which may be complex, for e^{iωt}; M₀ is ρc² of the given speed."""

    def relative_density(self, frequency: np.ndarray | float) -> np.ndarray:
        """ρ(ω)/ρ (...) at frequencies (...) Hz other than 0, which may be complex; by default 1."""
        return np.ones(np.shape(frequency), dtype=complex)

    @property
    def unrelaxed(self) -> float:
        """Stiffness of the springs with which ground is stepped over that of the given wave speeds; by default 1."""
        return 1.0

    @property
    def relaxed(self) -> float:
        """Stiffness at rest over the unrelaxed one; by default 1."""
        return 1.0

    @property
    def drag(self) -> float:
        """Force against the motion over mass and velocity, 1/s; by default none."""
        return 0.0

    @property
    def lag(self) -> float:
        """Time (s) β by which forces on fast motion grow, F = f + β df/dt, which shortens the step; by default none."""
        return 0.0

    def quality(self, frequency: np.ndarray | float) -> np.ndarray:
        """Q (...) at frequencies (...) Hz."""
        modulus, density = self.relative_modulus(frequency), self.relative_density(frequency)
        return np.asarray(1.0 / (modulus.imag / modulus.real - density.imag / density.real))

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest Q over the band."""
        found = self.quality(np.geomspace(*self.band, 201))
        return float(found.min()), float(found.max())


def factors_of(layers: Sequence[Attenuation | None], time_step: float) -> np.ndarray:
    """Factors e and g (layers, 2, K) of the memories of layers of ground; of undamped ones zero."""
    count = max((each.count for each in layers if each is not None), default=0)
    factors = np.zeros((len(layers), 2, count))
    for row, each in zip(factors, layers, strict=True):
        if each is not None:
            row[:, : each.count] = each.per_step(time_step)
    return factors


@dataclass(frozen=True)
class Rayleigh(Attenuation):
    """Rayleigh damping of one material.

    Attributes
    ----------
    alpha : α, 1/s. beta : β, s. band : the two frequencies, Hz, at which the damping ratio is the given one.
    """

    alpha: float
    beta: float
    band: tuple[float, float]

    @classmethod
    def fitted(cls, quality: float, band: tuple[float, float]) -> "Rayleigh":
        """Rayleigh damping with a quality factor at the two frequencies (Hz) of a band."""
        (low, high), ratio = band, 0.5 / quality
        return cls(4.0 * math.pi * ratio * low * high / (low + high), ratio / (math.pi * (low + high)), band)

    @property
    def frequency(self) -> float:  # type: ignore[override]  # an attribute of others
        """The middle of the band, Hz; wave speeds hold at all frequencies."""
        return math.sqrt(self.band[0] * self.band[1])

    @property
    def count(self) -> int:
        """Number of memories of each force."""
        return 2

    @property
    def drag(self) -> float:
        """α, 1/s."""
        return self.alpha

    @property
    def lag(self) -> float:
        """β, s."""
        return self.beta

    def per_step(self, time_step: float) -> np.ndarray:
        """Factors e and g (2, 2) of the memories for steps of this length (s)."""
        rate = self.beta / time_step
        return np.array([[0.0, -1.0], [rate, -2.0 * rate]])

    def relative_modulus(self, frequency: np.ndarray | float) -> np.ndarray:
        """1 + iωβ (...) at frequencies (...) Hz."""
        return np.asarray(1.0 + 2j * math.pi * self.beta * np.asarray(frequency))

    def relative_density(self, frequency: np.ndarray | float) -> np.ndarray:
        """1 − iα/ω (...) at frequencies (...) Hz."""
        return np.asarray(1.0 - 1j * self.alpha / (2.0 * math.pi * np.asarray(frequency)))


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
    def relaxed(self) -> float:
        """1 − Σw."""
        return 1.0 - math.fsum(self.weights)

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

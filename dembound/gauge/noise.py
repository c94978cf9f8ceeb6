"""Standard errors by noise and an uncertain baseline of a signal.

The *bootstrap*: noise from before the first wave, drawn in blocks to keep its spectrum, and baselines drawn from the
fit's covariance are added to the signal many times, and everything is estimated anew. The scatter of the estimates is
their standard error.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.gauge.baseline import Baseline
from dembound.gauge.peaks import CREST, digit, smooth, white_noise, width_of

SEED = 20160315
"""Seed of the random numbers: the same signal always has the same errors."""

MOST_DRAWS, FEWEST_DRAWS = 200, 40
"""Number of draws: of 200 a standard error is known to 5 %, of 40 to 11 %."""

SAMPLES = 1_000_000
"""Largest number of samples in all draws, which limits the draws in long records."""

BLOCKS = 4
"""Least number of blocks in the noise before the first wave."""


@dataclass(frozen=True)
class Noise:
    """Noise of a signal (k,).

    residuals : (r,) of consecutive quiet samples; block : length of the pieces drawn from them; functions : (k, m) and
    root : (m, m), a root of the covariance of the baseline's shares; smoothed : (k,) the signal, to find the rounding
    of its digitiser to steps of the size `digit`, 0 if noise is larger.
    """

    residuals: np.ndarray
    block: int
    functions: np.ndarray
    root: np.ndarray
    smoothed: np.ndarray
    digit: float

    def draws(self) -> Iterator[np.ndarray]:
        """Possible errors (k,) of the signal, the same in every call."""
        random = np.random.default_rng(SEED)
        count = len(self.functions)
        starts = len(self.residuals) - self.block + 1
        for _ in range(int(np.clip(SAMPLES // count, FEWEST_DRAWS, MOST_DRAWS))):
            begins = random.integers(0, starts, size=-(-count // self.block))
            noise = self.residuals[(begins[:, None] + np.arange(self.block)).ravel()[:count]]
            noise = noise + rounding(self.smoothed, self.digit, random)
            yield noise + self.functions @ (self.root @ random.standard_normal(self.root.shape[1]))


def rounding(values: np.ndarray, digit: float, random: np.random.Generator) -> np.ndarray:
    """Error (k,) of a digitiser with this step, 0 for none, whose levels lie anywhere; values : (k,) before it."""
    if not digit > 0.0:
        return np.zeros_like(values)
    levels = values / digit + random.uniform()
    return digit * (np.round(levels) - levels)


def undithered(values: np.ndarray) -> tuple[np.ndarray, float]:
    """A signal (k,) smoothed over an eighth of its largest passage, and the step of its digitiser.

    The step is 0 without a digitiser, and where noise is larger than half of it: the noise then includes rounding.
    """
    step = digit(values)
    if white_noise(values) > 0.5 * step:
        return values, 0.0
    return smooth(values, max(1, round(CREST * width_of(np.abs(values))))), step


def noise_of(values: np.ndarray, baseline: Baseline) -> Noise:
    """The noise of a signal (k,) from which its baseline, if worthwhile, is removed.

    From samples before the first wave if there are a hundred, else from all quiet samples. A baseline that was not
    removed adds an uncertain function.
    """
    quiet = np.flatnonzero(baseline.quiet)
    residuals = values[: baseline.before] if baseline.before >= 100 else values[quiet]
    sizes, directions = np.linalg.eigh(baseline.covariance)
    root = directions * np.sqrt(np.maximum(sizes, 0.0))
    functions = baseline.functions
    if not baseline.worthwhile:
        functions = np.column_stack([functions, baseline.values])
        root = np.block([[root, np.zeros((len(root), 1))], [np.zeros((1, len(root))), np.ones((1, 1))]])
    block = max(1, min(50, len(residuals) // BLOCKS))
    return Noise(residuals - residuals.mean(), block, functions, root, *undithered(values))

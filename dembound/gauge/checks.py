"""Refusals of signals and numbers that would silently give a wrong result."""

from collections.abc import Iterator

import numpy as np

from dembound.gauge.peaks import NOISE_FACTOR, white_noise, width_of
from dembound.meanings import MEANINGS

COARSE = 5
"""Least number of samples of the largest wave above half its height."""

SHARE_CLIPPED, LEAST_CLIPPED = 0.1, 5
"""Equal samples at an extreme value from which on it is taken for clipped: over the wave's width, and their number."""

ABRUPT = 8.0
"""Fall beside a crest, in steps of the digitiser, that indicates clipping; a round crest falls by four."""


def not_above_zero(option: str, value: float | None, unit: str) -> Iterator[str]:
    """Message about an option's value, in its unit, if it is not a positive number."""
    if value is not None and not 0.0 < value < np.inf:
        yield f"{option}: is {value:g} {unit}, must be finite and above 0"


def implausible_size(option: str, value: float | None, means: str, unit: str) -> Iterator[str]:
    """Message about an option whose value is not positive, or of a size unlikely for its meaning."""
    yield from (unfit := list(not_above_zero(option, value, unit)))
    if value is not None and not unfit and (doubt := MEANINGS[means].doubt(value, unit)):
        yield f"{option}: {doubt}"


def unfit_signal(values: np.ndarray, *, may_be_clipped: bool = False) -> Iterator[str]:
    """Messages about a signal (k,) that is noise, clipped, or sampled too coarsely for its largest wave."""
    sizes, noise = np.abs(values - np.median(values)), white_noise(values)
    if width_of(sizes) < COARSE and sizes.max() < NOISE_FACTOR * noise:
        yield f"the signal is noise: its largest value is {sizes.max() / noise:.2g} standard deviations, and no wave"
        return
    if (width := width_of(np.abs(values))) < COARSE:
        yield (
            f"the sampling is too coarse: the largest wave has {width} samples above half its height, needs {COARSE}; "
            "or it is a spike"
        )
    for sense, extreme in ((1.0, "largest"), (-1.0, "smallest")):
        if not may_be_clipped and (count := clipped(sense * values)):
            value = sense * float((sense * values).max())
            yield (
                f"the signal is clipped: {count} samples in a row have its {extreme} value, {value:.4g}; record it "
                "with a larger range, or allow it with --clipped if it is the wave's own plateau"
            )


def clipped(values: np.ndarray) -> int:
    """Number of equal samples at the largest value of a signal (k,) whose slope breaks off there; 0 if it does not."""
    top = float(values.max())
    at = np.flatnonzero(np.diff(np.concatenate([[0], values == top, [0]])))
    starts, ends = at[::2], at[1::2]
    longest = int((ends - starts).argmax())
    first, count = int(starts[longest]), int(ends[longest] - starts[longest])
    if top <= 0.0 or count < max(LEAST_CLIPPED, SHARE_CLIPPED * width_of(np.maximum(values, 0.0))):
        return 0
    step = float(np.diff(np.unique(values)[-50:]).min())
    fall = top - float(values[max(first - count // 2, 0)])
    return count if fall > ABRUPT * step else 0

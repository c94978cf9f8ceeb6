"""Responses in time from their Laplace transforms, and ratios of modified Bessel functions."""

import math
from collections.abc import Callable, Sequence

import numpy as np

EXTRA = 30
"""Orders above the last one at which the recurrence downwards begins; each multiplies its error by (z/2n)² or less."""


def decaying_ratios(z: np.ndarray, orders: int) -> np.ndarray:
    """K_{n+1}(z)/K_n(z) (orders, m) at z (m,)."""
    from scipy.special import kve

    ratios = np.empty((orders, len(z)), dtype=complex)
    ratios[0] = kve(1, z) / kve(0, z)
    for n in range(1, orders):
        ratios[n] = 1.0 / ratios[n - 1] + 2.0 * n / z
    return ratios


def growing_ratios(z: np.ndarray, orders: int) -> np.ndarray:
    """I_{n+1}(z)/I_n(z) (orders, m) at z (m,); the orders must reach beyond |z|."""
    ratios = np.empty((orders, len(z)), dtype=complex)
    ratio = np.zeros_like(z)
    for n in range(orders + EXTRA, 0, -1):
        ratio = 1.0 / (2.0 * n / z + ratio)
        if n <= orders:
            ratios[n - 1] = ratio
    return ratios


def from_ratios(first: np.ndarray, ratios: np.ndarray) -> np.ndarray:
    """Functions (orders, m) of all orders from the function of order 0, (m,), and the ratios (orders, m)."""
    return np.cumprod(np.concatenate([first[None], ratios[:-1]]), axis=0)


Signal = Callable[[np.ndarray], np.ndarray]
"""Values at an array of times t ≥ 0 (s); zero before t = 0."""

Response = Callable[[np.ndarray], list[np.ndarray]]
"""Transforms of several kinds, each (…, m), of the response to a unit impulse at m complex frequencies s (rad/s)."""

WINDOW = 8.0
"""Length of the window over the latest requested time."""

DAMPING = math.log(1e8)
"""cW: an event one window later is damped by e to its power."""

FEWEST, MOST = 2**11, 2**20
"""Numbers of samples in the window."""

NEGLIGIBLE = 1e-5
"""Share of the tolerance times the signal's largest amplitude below which a frequency is left out."""


def respond(
    response: Response,
    signal: Signal,
    times: np.ndarray,
    tolerance: float,
    sizes: Sequence[float],
    known: Sequence[np.ndarray] | None = None,
    most: int = MOST,
) -> list[np.ndarray]:
    """Responses (…, k) of all kinds to a signal at times (k,) s, which may be negative.

    The samples in the window are doubled until the last doubling has changed each kind by less than `tolerance` times
    its largest value, or times its usual size, in `sizes`, if that is larger: a response may not have arrived yet.
    known : parts of the responses that are not in the transforms, and are added. most : largest number of samples.

    Raises RuntimeError if the tolerance is not reached: the smoother the response, the fewer doublings are needed; a
    response that jumps never converges.
    """
    times = np.asarray(times, dtype=float)
    frequencies = _Frequencies(response, WINDOW * float(np.abs(times).max(initial=1e-300)), NEGLIGIBLE * tolerance)
    samples, change = FEWEST, math.inf
    coarser: list[np.ndarray] | None = None
    while change > tolerance:
        if samples > most:
            raise RuntimeError(f"the response does not converge to {tolerance:g}: is the signal continuous?")
        finer = frequencies.sum(signal, samples, times)
        if known is not None:
            finer = [part + more for part, more in zip(finer, known, strict=True)]
        if coarser is not None:
            change = max(_change(*kind) for kind in zip(coarser, finer, sizes, strict=True))
        samples, coarser = 2 * samples, finer
    return finer


class _Frequencies:
    """The response at the frequencies of a window, where the signal has any; doubled samples add some."""

    def __init__(self, response: Response, length: float, negligible: float) -> None:
        self._response, self._length, self._negligible = response, length, negligible
        self._number = np.empty(0, dtype=int)
        self._values: list[np.ndarray] = []

    def sum(self, signal: Signal, samples: int, times: np.ndarray) -> list[np.ndarray]:
        """Responses (…, k) at times (k,) s to a signal with a number of samples in the window."""
        from scipy.interpolate import CubicSpline

        step, rate = self._length / samples, DAMPING / self._length
        grid = step * np.arange(samples)
        damped = signal(grid) * np.exp(-rate * grid)
        damped[0] *= 0.5  # the middle of a jump at t = 0
        spectrum = np.fft.rfft(damped)[:-1]
        self._add(np.flatnonzero(np.abs(spectrum) > self._negligible * np.abs(spectrum).max()))
        used = self._number < samples // 2
        near = np.arange(math.floor(times.min(initial=0.0) / step) - 4, math.ceil(times.max(initial=0.0) / step) + 5)
        growth = np.exp(rate * step * near)
        responses = []
        for values in self._values:
            product = np.zeros((*values.shape[:-1], samples // 2 + 1), dtype=complex)
            product[..., self._number[used]] = values[..., used] * spectrum[self._number[used]]
            whole = np.fft.irfft(product, samples, axis=-1)
            responses.append(CubicSpline(step * near, growth * whole[..., near % samples], axis=-1)(times))
        return responses

    def _add(self, number: np.ndarray) -> None:
        """Compute the response at the frequencies with these numbers where it is not yet known."""
        new = np.setdiff1d(number, self._number)
        if len(new) > 0 or not self._values:
            more = self._response((DAMPING + 2j * math.pi * new) / self._length)
            known = self._values or [values[..., :0] for values in more]
            self._values = [np.concatenate(pair, axis=-1) for pair in zip(known, more, strict=True)]
            self._number = np.concatenate([self._number, new])


def _change(coarse: np.ndarray, fine: np.ndarray, size: float) -> float:
    """Largest difference over the largest value, or over the usual size if that is larger."""
    size = float(np.abs(fine).max(initial=size))
    return float(np.abs(fine - coarse).max(initial=0.0)) / size if size > 0.0 else 0.0

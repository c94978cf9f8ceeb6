"""Motions in time from their transforms: of responses to an impulse, and of what follows from an incident wave.

What follows from an incident wave by factors to its spectrum are histories: the velocity v of the wave is sampled from
where it begins, and fades beyond the last time that is asked for. With e^{−εt} v(t), which decays within the window,
its Fourier transform is that at the frequencies ω − iε, and so are all motions that it causes: what comes round again
is `DECAY` times smaller.
"""

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

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


PADDED = 4
"""Length of the window of a history over that of the history, at least; a power of two in samples."""

DECAY = math.log(1e8)
"""Decay of signals over a window: what comes round again has 1e-8 of its size."""

POINTS = 10
"""Samples from which a value between them is interpolated: with eight in a period to 2e-5, with sixteen to 2e-8."""

RATE = 0.25
"""Part of the band of samples above which a wave has less than `FAINT` of its largest amplitude, if they suffice."""

FAINT, NONE = 1e-6, 1e-10
"""Amplitude over the largest one that is hardly visible, and that is left out."""

FEWEST_SAMPLES, MOST_SAMPLES = 2**9, 2**16
"""Least and largest number of samples up to the last time."""

FADING = 0.5
"""Time in which a wave fades beyond the last time, over that from its begin."""


class Window(NamedTuple):
    """Samples of a wave: how many up to the last time, step, s, and rate ε, 1/s; frequencies, Hz, and spectrum."""

    kept: int
    step: float
    rate: float
    frequencies: np.ndarray
    spectrum: np.ndarray

    def derived(self, derivatives: int) -> np.ndarray:
        """The spectrum (k,) of a derivative in time of the displacement."""
        return np.asarray(self.spectrum * (2j * math.pi * self.frequencies) ** (derivatives - 1))

    def sampled(self, spectrum: np.ndarray, finer: int = 1) -> np.ndarray:
        """The history (n,) of a spectrum at samples that are so many times finer, after `POINTS` samples at rest."""
        count = finer * self.kept + POINTS
        growth = np.exp(self.rate * self.step / finer * np.arange(count))
        history = finer * np.fft.irfft(spectrum, finer * PADDED * self.kept)[:count] * growth
        return np.concatenate([np.zeros(POINTS), history])


class Histories:
    """The window of an incident wave, and samples of what follows from it, which are kept.

    Parameters
    ----------
    velocity : m/s at times in s, of the incident wave alone. begin : time (s) before which it is zero. until : last
    time (s); later ones double the window.
    """

    def __init__(self, velocity: Callable[[np.ndarray], np.ndarray], begin: float, until: float) -> None:
        self.begin = begin
        self._velocity, self._until = velocity, until
        self._found: dict[object, np.ndarray] = {}

    def reach(self, times: np.ndarray) -> None:
        """Make the window long enough for times, s; what was kept is gone if it is not."""
        while times.max(initial=self.begin) > self._until:
            self._until += self._until - self.begin
            self._found.clear()
            self.__dict__.pop("window", None)

    def kept(self, key: object, find: Callable[[], np.ndarray]) -> np.ndarray:
        """What was found once for a key and this window."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]

    @cached_property
    def window(self) -> Window:
        """The samples of the incident wave."""
        length, count = self._until - self.begin, FEWEST_SAMPLES
        while True:
            step, window = length / count, PADDED * count
            times = step * np.arange(window)
            fade = np.clip((times - length) / step - POINTS, 0.0, None) / (FADING * count)
            left = 1.0 - _risen(np.minimum(fade, 1.0))
            kept = left > 0.0
            rate = DECAY / (window * step)
            values = np.zeros(window)
            values[kept] = left[kept] * self._velocity(self.begin + times[kept]) * np.exp(-rate * times[kept])
            spectrum = np.fft.rfft(values)
            size = np.abs(spectrum)
            above = size[int(RATE * len(size)) :].max()
            if above <= FAINT * size.max() or count >= MOST_SAMPLES:
                last = int(np.flatnonzero(size > NONE * size.max()).max(initial=0)) + 1
                frequencies = np.fft.rfftfreq(window, step)[:last] - 1j * rate / (2.0 * math.pi)
                return Window(count, step, rate, frequencies, spectrum[:last])
            count *= 2

    def between(self, samples: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Values (k, d) at times (k,) s between samples (n, d), from `POINTS` of them."""
        places = (times - self.begin) / self.window.step
        first = np.floor(places).astype(np.int64) - POINTS // 2 + 1
        points = np.arange(POINTS)
        away = (places - first)[:, None] - points  # in steps, from each sample
        weights = np.ones(away.shape)
        for own in points:
            for other in points[points != own]:
                weights[:, own] *= away[:, other] / (own - other)
        rows = np.clip(first[:, None] + points + POINTS, 0, len(samples) - 1)
        return np.asarray(np.einsum("kj,kjd->kd", weights, samples[rows]))

    def by_slopes(self, samples: np.ndarray, slopes: np.ndarray, finer: int, times: np.ndarray) -> np.ndarray:
        """Values at times (any shape) s between fine samples (n,), from two of them and of their derivatives (n,).

        In a tenth of the time of `between`; with 32 fine samples in a period to 4e-6.
        """
        step = self.window.step / finer
        places = np.clip((times - self.begin) / step + POINTS, 0.0, len(samples) - 1.5)
        row = places.astype(np.int64)
        x = places - row
        left, right = samples[row], samples[row + 1]
        a, b = step * slopes[row] - (right - left), (right - left) - step * slopes[row + 1]
        return np.asarray(left + x * (right - left) + x * (1.0 - x) * ((1.0 - x) * a + x * b))


def _risen(x: np.ndarray) -> np.ndarray:
    """From 0 at 0 to 1 at 1 with three derivatives that are zero at both."""
    return np.asarray(x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3))
